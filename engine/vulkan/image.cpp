#include "engine/vulkan/image.h"

#include "engine/vulkan/errors.h"

#include <vulkan/vulkan_format_traits.hpp>

namespace pmdsim::vulkan {

namespace {

vk::ImageCreateInfo plane_of(vk::Extent2D extent, vk::Format format, vk::ImageTiling tiling,
                             vk::ImageUsageFlags usage) {
  return {{},
          vk::ImageType::e2D,
          format,
          {extent.width, extent.height, 1},
          1,
          1,
          vk::SampleCountFlagBits::e1,
          tiling,
          usage};
}

bool can_make(const Device &device, const vk::ImageCreateInfo &info) {
  try {
    const vk::Extent3D largest =
        device.physical()
            .getImageFormatProperties(info.format, info.imageType, info.tiling, info.usage, info.flags)
            .maxExtent;
    return info.extent.width <= largest.width && info.extent.height <= largest.height;
  } catch (const vk::FormatNotSupportedError &) {
    return false;
  }
}

} // namespace

Image::Image(const Device &device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage,
             vk::ImageAspectFlags aspect)
    : aspect_(aspect) {
  checked([&] {
    image_ = vk::raii::Image(device.get(), plane_of(extent, format, vk::ImageTiling::eOptimal, usage));
    const vk::MemoryRequirements needs = image_.getMemoryRequirements();
    const auto type = device.memory_type(needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal, {});
    memory_ = vk::raii::DeviceMemory(device.get(), vk::MemoryAllocateInfo(needs.size, type));
    image_.bindMemory(*memory_, 0);
    make_view(device, format);
  });
}

std::optional<Image> Image::on_buffer(const Device &device, vk::Extent2D extent, vk::Format format,
                                      vk::ImageUsageFlags usage, const Buffer &buffer) {
  const vk::ImageCreateInfo info = plane_of(extent, format, vk::ImageTiling::eLinear, usage);
  return checked([&]() -> std::optional<Image> {
    if (!can_make(device, info))
      return std::nullopt;
    Image made;
    made.aspect_ = vk::ImageAspectFlagBits::eColor;
    made.image_ = vk::raii::Image(device.get(), info);
    const vk::SubresourceLayout layout = made.image_.getSubresourceLayout({made.aspect_, 0, 0});
    const vk::MemoryRequirements needs = made.image_.getMemoryRequirements();
    if (layout.offset != 0 || layout.rowPitch != vk::DeviceSize{extent.width} * vk::blockSize(format) ||
        needs.size > buffer.bytes() || (needs.memoryTypeBits >> buffer.memory_type() & 1) == 0)
      return std::nullopt;
    made.image_.bindMemory(buffer.memory(), 0);
    made.make_view(device, format);
    return made;
  });
}

void Image::make_view(const Device &device, vk::Format format) {
  view_ = vk::raii::ImageView(device.get(), vk::ImageViewCreateInfo({}, *image_, vk::ImageViewType::e2D,
                                                                    format, {}, {aspect_, 0, 1, 0, 1}));
}

void Image::transition(const vk::raii::CommandBuffer &commands, vk::ImageLayout from, vk::ImageLayout to,
                       vk::PipelineStageFlags2 after, vk::AccessFlags2 written,
                       vk::PipelineStageFlags2 before, vk::AccessFlags2 used) const {
  const vk::ImageMemoryBarrier2 barrier(after, written, before, used, from, to, VK_QUEUE_FAMILY_IGNORED,
                                        VK_QUEUE_FAMILY_IGNORED, *image_, {aspect_, 0, 1, 0, 1});
  commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barrier));
}

} // namespace pmdsim::vulkan
