#pragma once
// A two-dimensional attachment with its own memory and its view.

#include "engine/vulkan/device.h"

#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

class Image {
public:
  Image() = default;
  Image(const Device &device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage,
        vk::ImageAspectFlags aspect);

  vk::Image get() const { return *image_; }
  vk::ImageView view() const { return *view_; }

  // Moves the whole image from one layout to another, with the dependency that goes with it.
  void transition(const vk::raii::CommandBuffer &commands, vk::ImageLayout from, vk::ImageLayout to,
                  vk::PipelineStageFlags2 after, vk::AccessFlags2 written, vk::PipelineStageFlags2 before,
                  vk::AccessFlags2 used) const;

private:
  vk::ImageAspectFlags aspect_;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Image image_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
};

} // namespace pmdsim::vulkan
