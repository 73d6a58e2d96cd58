#pragma once
// A shader with the values of its constants, as a pipeline is made of it.

#include "engine/vulkan/device.h"
#include "engine/vulkan/shader_module.h"

#include <cstdint>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

// To be kept until the pipeline is made.
class ShaderStage {
public:
  // `constants`: the module's, as declared_part() tells.
  ShaderStage(const Device &device, vk::ShaderStageFlagBits stage, const ShaderModule &module,
              const Specialization &constants);
  ShaderStage(const ShaderStage &) = delete;
  ShaderStage &operator=(const ShaderStage &) = delete;

  const vk::PipelineShaderStageCreateInfo &info() const { return info_; }

private:
  vk::raii::ShaderModule module_;
  std::vector<vk::SpecializationMapEntry> entries_;
  std::vector<std::uint32_t> values_;
  vk::SpecializationInfo specialization_;
  vk::PipelineShaderStageCreateInfo info_;
};

} // namespace pmdsim::vulkan
