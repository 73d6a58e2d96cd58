#include "engine/vulkan/compute_pipeline.h"

#include "engine/vulkan/errors.h"
#include "engine/vulkan/shader_stage.h"

namespace pmdsim::vulkan {
namespace {

Pipeline compile(const Device &device, const ShaderModule &module, std::uint32_t push_constant_bytes,
                 const Specialization &constants) {
  return checked([&] {
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_constant_bytes);
    vk::raii::PipelineLayout layout(device.get(), vk::PipelineLayoutCreateInfo({}, {}, range));
    const ShaderStage stage(device, vk::ShaderStageFlagBits::eCompute, module, constants);
    vk::raii::Pipeline pipeline(device.get(), nullptr,
                                vk::ComputePipelineCreateInfo({}, stage.info(), *layout));
    return Pipeline{std::move(layout), std::move(pipeline)};
  });
}

} // namespace

ComputePipeline::ComputePipeline(const Device &device, const ShaderModule &module,
                                 std::size_t push_constant_bytes, const Specialization &constants)
    : push_constant_bytes_(static_cast<std::uint32_t>(push_constant_bytes)) {
  if (push_constant_bytes > 128)
    throw std::logic_error("more push constants than every device has");
  const Specialization own = declared_part(module, constants);
  compiled_ = device.pipelines().get({module.spirv.data(), own},
                                     [&] { return compile(device, module, push_constant_bytes_, own); });
}

} // namespace pmdsim::vulkan
