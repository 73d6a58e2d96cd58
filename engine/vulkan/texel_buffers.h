#pragma once
// Buffers that a shader reads texel by texel, bound to it one beside the other.

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"

#include <initializer_list>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

struct TexelView {
  const Buffer &buffer; // with the usage eUniformTexelBuffer
  vk::Format format;
};

// The layout of so many of them, in set 0.
vk::raii::DescriptorSetLayout texel_layout(const Device &device, std::uint32_t count);

class TexelBuffers {
public:
  TexelBuffers() = default;
  // The buffers outlive it. Throws Error (out_of_memory) where one has more texels than the device can
  // address.
  TexelBuffers(const Device &device, std::initializer_list<TexelView> buffers);

  vk::DescriptorSet get() const { return *set_; }

private:
  std::vector<vk::raii::BufferView> views_;
  vk::raii::DescriptorSetLayout layout_ = nullptr;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
};

} // namespace pmdsim::vulkan
