#include "engine/vulkan/image.h"

#include "engine/vulkan/errors.h"

namespace pmdsim::vulkan {

Image::Image(const Device &device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage,
             vk::ImageAspectFlags aspect)
    : aspect_(aspect) {
  checked([&] {
    image_ = vk::raii::Image(
        device.get(), vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {extent.width, extent.height, 1}, 1,
                                          1, vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal, usage));
    const vk::MemoryRequirements needs = image_.getMemoryRequirements();
    const auto type = device.memory_type(needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal, {});
    memory_ = vk::raii::DeviceMemory(device.get(), vk::MemoryAllocateInfo(needs.size, type));
    image_.bindMemory(*memory_, 0);
    view_ = vk::raii::ImageView(device.get(), vk::ImageViewCreateInfo({}, *image_, vk::ImageViewType::e2D,
                                                                      format, {}, {aspect, 0, 1, 0, 1}));
  });
}

void Image::transition(const vk::raii::CommandBuffer &commands, vk::ImageLayout from, vk::ImageLayout to,
                       vk::PipelineStageFlags2 after, vk::AccessFlags2 written,
                       vk::PipelineStageFlags2 before, vk::AccessFlags2 used) const {
  const vk::ImageMemoryBarrier2 barrier(after, written, before, used, from, to, VK_QUEUE_FAMILY_IGNORED,
                                        VK_QUEUE_FAMILY_IGNORED, *image_, {aspect_, 0, 1, 0, 1});
  commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barrier));
}

} // namespace pmdsim::vulkan
