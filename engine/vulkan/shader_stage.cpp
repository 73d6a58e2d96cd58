#include "engine/vulkan/shader_stage.h"

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

} // namespace pmdsim::vulkan
