#include "engine/vulkan/compute_pipeline.h"

#include "engine/vulkan/errors.h"

namespace pmdsim::vulkan {
namespace {

Pipeline compile(const Device &device, std::span<const std::uint32_t> spirv,
                 std::uint32_t push_constant_bytes, const Specialization &constants) {
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i)
    entries.emplace_back(i, i * std::uint32_t{sizeof(std::uint32_t)}, sizeof(std::uint32_t));
  const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size() * sizeof(std::uint32_t), constants.data());
  return checked([&] {
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_constant_bytes);
    vk::raii::PipelineLayout layout(device.get(), vk::PipelineLayoutCreateInfo({}, {}, range));
    const vk::raii::ShaderModule module(device.get(),
                                        vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                  &specialization);
    vk::raii::Pipeline pipeline(device.get(), nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
    return Pipeline{std::move(layout), std::move(pipeline)};
  });
}

} // namespace

ComputePipeline::ComputePipeline(const Device &device, std::span<const std::uint32_t> spirv,
                                 std::uint32_t push_constant_bytes, const Specialization &constants)
    : push_constant_bytes_(push_constant_bytes) {
  if (push_constant_bytes > 128)
    throw std::logic_error("more push constants than every device has");
  compiled_ = device.pipelines().get(spirv.data(), constants,
                                     [&] { return compile(device, spirv, push_constant_bytes, constants); });
}

} // namespace pmdsim::vulkan
