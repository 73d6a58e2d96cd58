#include "engine/vulkan/texel_buffers.h"

#include "engine/vulkan/errors.h"

#include <string>

namespace pmdsim::vulkan {

vk::raii::DescriptorSetLayout texel_layout(const Device &device, std::uint32_t count) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t binding = 0; binding < count; ++binding)
    bindings.emplace_back(binding, vk::DescriptorType::eUniformTexelBuffer, 1,
                          vk::ShaderStageFlagBits::eCompute);
  return {device.get(), vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

TexelBuffers::TexelBuffers(const Device &device, std::initializer_list<TexelView> buffers) {
  const auto count = static_cast<std::uint32_t>(buffers.size());
  checked([&] {
    layout_ = texel_layout(device, count);
    const vk::DescriptorPoolSize size(vk::DescriptorType::eUniformTexelBuffer, count);
    pool_ = vk::raii::DescriptorPool(
        device.get(),
        vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
    set_ = std::move(
        vk::raii::DescriptorSets(device.get(), vk::DescriptorSetAllocateInfo(*pool_, *layout_)).front());
    for (const auto &[buffer, format] : buffers)
      views_.emplace_back(device.get(),
                          vk::BufferViewCreateInfo({}, buffer.get(), format, 0, buffer.bytes()));
  });
  std::vector<vk::BufferView> views;
  for (const vk::raii::BufferView &view : views_)
    views.push_back(*view);
  for (std::uint32_t binding = 0; binding < count; ++binding)
    device.get().updateDescriptorSets(vk::WriteDescriptorSet(*set_, binding, 0, 1,
                                                             vk::DescriptorType::eUniformTexelBuffer, nullptr,
                                                             nullptr, &views[binding]),
                                      nullptr);
}

} // namespace pmdsim::vulkan
