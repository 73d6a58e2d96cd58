#include "engine/vulkan/compute_pipeline.h"

#include "engine/vulkan/errors.h"

#include <vector>

namespace pmdsim::vulkan {

ShaderStage::ShaderStage(const Device &device, vk::ShaderStageFlagBits stage, const ShaderModule &module,
                         const Specialization &constants)
    : module_(device.get(), vk::ShaderModuleCreateInfo({}, module.spirv.size_bytes(), module.spirv.data())) {
  for (const auto &[number, value] : constants.values()) {
    const auto offset = static_cast<std::uint32_t>(values_.size() * sizeof(value));
    entries_.emplace_back(number, offset, sizeof(value));
    values_.push_back(value);
  }
  specialization_.setMapEntries(entries_)
      .setDataSize(values_.size() * sizeof(std::uint32_t))
      .setPData(values_.data());
  info_ = {{}, stage, *module_, "main", &specialization_};
}

ComputePipeline::ComputePipeline(const Device &device, const ShaderModule &module,
                                 std::size_t push_constant_bytes, const Specialization &constants,
                                 const SubgroupUse &subgroups)
    : push_constant_bytes_(static_cast<std::uint32_t>(push_constant_bytes)) {
  if (push_constant_bytes > 128)
    throw std::logic_error("more push constants than every device has");
  const Specialization own = declared_part(module, constants);
  const auto compile = [&] {
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, push_constant_bytes_);
    std::vector<vk::raii::DescriptorSetLayout> sets;
    std::vector<vk::DescriptorSetLayout> handles;
    if (subgroups.texel_buffers > 0) {
      sets.push_back(texel_layout(device, subgroups.texel_buffers));
      handles.push_back(*sets.back());
    }
    vk::raii::PipelineLayout layout(device.get(), vk::PipelineLayoutCreateInfo({}, handles, range));
    const ShaderStage stage(device, vk::ShaderStageFlagBits::eCompute, module, own);
    vk::PipelineShaderStageCreateInfo info = stage.info();
    const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo size(subgroups.size);
    if (subgroups.size > 0 && device.limits().subgroups_sized) {
      info.setPNext(&size);
      info.setFlags(vk::PipelineShaderStageCreateFlagBits::eRequireFullSubgroups);
    }
    vk::raii::Pipeline pipeline(device.get(), nullptr, vk::ComputePipelineCreateInfo({}, info, *layout));
    return Pipeline{std::move(layout), std::move(pipeline)};
  };
  compiled_ = device.pipelines().get({module.spirv.data(), own}, [&] { return checked(compile); });
}

} // namespace pmdsim::vulkan
