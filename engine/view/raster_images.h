#pragma once
// The images that the ID raster draws on: one of depths, and one of IDs, which lies in the very buffer that
// the IDs are wanted in where it can.

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"

#include <optional>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim {

class RasterImages {
public:
  static constexpr vk::Format depth_format = vk::Format::eD32Sfloat;

  // Large enough for each of `extents`. `id_buffer`: the buffer, which stays there; `previous`: of passes
  // that are done with, whose memory is taken where it can be.
  RasterImages(const vulkan::Device &device, const std::vector<vk::Extent2D> &extents, vk::Format id_format,
               const vulkan::Buffer &id_buffer, std::optional<RasterImages> &&previous);

  // Begins to draw on `extent`, where no ID is left from before and all depths are 0.
  void begin(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const;
  // Ends that: the IDs are in the buffer row by row, visible to compute shaders and transfers. If the extent
  // is not one of those asked for, and not as wide, only the first row may be there.
  void end(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const;

  // To be called before the buffer goes: only what others may take stays.
  void leave_buffer();

private:
  std::pair<vk::ImageLayout, vk::AttachmentLoadOp> begin_ids(const vk::raii::CommandBuffer &commands,
                                                             vk::Extent2D extent) const;
  void copy_ids(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const;

  vk::Extent2D extent_;
  vk::Format id_format_;
  const vulkan::Buffer *id_buffer_;
  vulkan::Image depth_;
  std::optional<vulkan::Image> ids_; // nothing after leave_buffer
  bool in_place_ = false;            // the IDs lie in the buffer, and need no copy
};

} // namespace pmdsim
