#pragma once
// A two-dimensional attachment with its view, in its own memory or on a buffer's.

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"

#include <optional>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

class Image {
public:
  Image() = default;
  Image(const Device &device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage,
        vk::ImageAspectFlags aspect);
  // A colour image that lies in the buffer's memory row by row, so that in layout eGeneral the buffer has
  // what is drawn; nothing where the device has no such images, leaves gaps between rows or needs more memory
  // than there is. The image must not be used longer than the buffer.
  static std::optional<Image> on_buffer(const Device &device, vk::Extent2D extent, vk::Format format,
                                        vk::ImageUsageFlags usage, const Buffer &buffer);

  vk::Image get() const { return *image_; }
  vk::ImageView view() const { return *view_; }

  // Moves the whole image from one layout to another, with the dependency that goes with it.
  void transition(const vk::raii::CommandBuffer &commands, vk::ImageLayout from, vk::ImageLayout to,
                  vk::PipelineStageFlags2 after, vk::AccessFlags2 written, vk::PipelineStageFlags2 before,
                  vk::AccessFlags2 used) const;

private:
  void make_view(const Device &device, vk::Format format);

  vk::ImageAspectFlags aspect_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Image image_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
};

} // namespace pmdsim::vulkan
