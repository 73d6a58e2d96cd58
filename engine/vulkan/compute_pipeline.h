#pragma once
// Shaders, specialised: as a stage of any pipeline, and compute shaders, whose interface is their push
// constants (buffers go by address) and, where they have any, texel buffers.

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/shader_module.h"
#include "engine/vulkan/texel_buffers.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

// A shader with the values of its constants, as a pipeline is made of it; to be kept until then.
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

// The needs of a shader whose workgroups are subgroups.
struct SubgroupUse {
  std::uint32_t texel_buffers = 0;
  std::uint32_t size = 0; // 0: any
};

class ComputePipeline {
public:
  ComputePipeline() = default;
  // `constants`: all that the module declares, and any others. Throws std::logic_error where one is missing.
  ComputePipeline(const Device &device, const ShaderModule &module, std::size_t push_constant_bytes,
                  const Specialization &constants = {}, const SubgroupUse &subgroups = {});

  // Dispatches `invocations` / `workgroup` workgroups; the former is a multiple of the latter.
  template <typename Constants>
  void dispatch(const vk::raii::CommandBuffer &commands, const Constants &constants,
                std::uint32_t invocations, std::uint32_t workgroup,
                const TexelBuffers *texels = nullptr) const {
    if (invocations % workgroup != 0)
      throw std::logic_error("a dispatch does not consist of whole workgroups");
    bind(commands, constants, texels);
    commands.dispatch(invocations / workgroup, 1, 1);
  }

  // As many workgroups as three words in `arguments`, from `offset` bytes on, say when the device comes to
  // it.
  template <typename Constants>
  void dispatch_indirect(const vk::raii::CommandBuffer &commands, const Constants &constants,
                         const Buffer &arguments, vk::DeviceSize offset,
                         const TexelBuffers *texels = nullptr) const {
    bind(commands, constants, texels);
    commands.dispatchIndirect(arguments.get(), offset);
  }

private:
  template <typename Constants>
  void bind(const vk::raii::CommandBuffer &commands, const Constants &constants,
            const TexelBuffers *texels) const {
    if (sizeof(Constants) != push_constant_bytes_)
      throw std::logic_error("push constants do not fit their pipeline");
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *compiled_->pipeline);
    if (texels != nullptr)
      commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *compiled_->layout, 0, texels->get(),
                                  nullptr);
    commands.pushConstants<Constants>(*compiled_->layout, vk::ShaderStageFlagBits::eCompute, 0, constants);
  }

  std::uint32_t push_constant_bytes_ = 0;
  std::shared_ptr<const Pipeline> compiled_;
};

} // namespace pmdsim::vulkan
