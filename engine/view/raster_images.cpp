#include "engine/view/raster_images.h"

#include "engine/vulkan/commands.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vulkan/vulkan_format_traits.hpp>

namespace pmdsim {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;
using Usage = vk::ImageUsageFlagBits;

constexpr auto depth_tests = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
constexpr auto users_of_ids = Stage::eComputeShader | Stage::eTransfer;
constexpr auto uses_of_ids = Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eTransferRead;

vk::Extent2D largest_of(const std::vector<vk::Extent2D> &extents) {
  vk::Extent2D largest;
  for (const vk::Extent2D &extent : extents) {
    largest.width = std::max(largest.width, extent.width);
    largest.height = std::max(largest.height, extent.height);
  }
  return largest;
}

// Lavapipe draws on linear images as fast as on others; GPUs may not.
std::optional<vulkan::Image> image_in_place(const vulkan::Device &device,
                                            const std::vector<vk::Extent2D> &extents, vk::Extent2D largest,
                                            vk::Format format, const vulkan::Buffer &id_buffer) {
  const bool equally_wide =
      std::ranges::all_of(extents, [&](const vk::Extent2D &extent) { return extent.width == largest.width; });
  if (!device.is_cpu() || !equally_wide)
    return std::nullopt;
  return vulkan::Image::on_buffer(device, largest, format, Usage::eColorAttachment, id_buffer);
}

} // namespace

RasterImages::RasterImages(const vulkan::Device &device, const std::vector<vk::Extent2D> &extents,
                           vk::Format format, const vulkan::Buffer &id_buffer,
                           std::optional<RasterImages> &&previous)
    : extent_(largest_of(extents)), id_format_(format), id_buffer_(&id_buffer) {
  if (previous && previous->extent_ != extent_)
    previous.reset(); // its memory first
  depth_ = previous ? std::move(previous->depth_)
                    : vulkan::Image(device, extent_, depth_format, Usage::eDepthStencilAttachment,
                                    vk::ImageAspectFlagBits::eDepth);
  ids_ = image_in_place(device, extents, extent_, format, id_buffer);
  in_place_ = ids_.has_value();
  if (!in_place_ && previous && previous->id_format_ == format)
    ids_ = std::move(previous->ids_);
  if (!ids_) {
    previous.reset();
    ids_.emplace(device, extent_, format, Usage::eColorAttachment | Usage::eTransferSrc,
                 vk::ImageAspectFlagBits::eColor);
  }
}

void RasterImages::leave_buffer() {
  if (in_place_)
    ids_.reset();
}

void RasterImages::begin(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const {
  const auto [layout, load] = begin_ids(commands, extent);
  depth_.transition(commands, Layout::eUndefined, Layout::eDepthAttachmentOptimal, depth_tests,
                    Access::eDepthStencilAttachmentWrite, depth_tests,
                    Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);
  const vk::RenderingAttachmentInfo color(ids_->view(), layout, vk::ResolveModeFlagBits::eNone, {},
                                          Layout::eUndefined, load, vk::AttachmentStoreOp::eStore,
                                          vk::ClearColorValue(std::array<std::uint32_t, 4>{}));
  const vk::RenderingAttachmentInfo depth(
      depth_.view(), Layout::eDepthAttachmentOptimal, vk::ResolveModeFlagBits::eNone, {}, Layout::eUndefined,
      vk::AttachmentLoadOp::eClear, vk::AttachmentStoreOp::eDontCare, vk::ClearDepthStencilValue(0.0f));
  commands.beginRendering(vk::RenderingInfo({}, {{0, 0}, extent}, 1, 0, color, &depth));
}

// The layout in which the IDs are drawn, and whether they are still to be cleared. Lavapipe clears images of
// more than 4 bytes a pixel one pixel after the other, but fills buffers.
std::pair<Layout, vk::AttachmentLoadOp> RasterImages::begin_ids(const vk::raii::CommandBuffer &commands,
                                                                vk::Extent2D extent) const {
  if (!in_place_) {
    ids_->transition(commands, Layout::eUndefined, Layout::eColorAttachmentOptimal, Stage::eTransfer, {},
                     Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite);
    return {Layout::eColorAttachmentOptimal, vk::AttachmentLoadOp::eClear};
  }
  ids_->transition(commands, Layout::eUndefined, Layout::eGeneral, users_of_ids, {}, Stage::eTransfer,
                   Access::eTransferWrite);
  commands.fillBuffer(id_buffer_->get(), 0,
                      vk::DeviceSize{extent.width} * extent.height * vk::blockSize(id_format_), 0);
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eColorAttachmentOutput,
                         Access::eColorAttachmentRead | Access::eColorAttachmentWrite);
  return {Layout::eGeneral, vk::AttachmentLoadOp::eLoad};
}

void RasterImages::end(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const {
  commands.endRendering();
  if (in_place_)
    vulkan::memory_barrier(commands, Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
                           users_of_ids, uses_of_ids);
  else
    copy_ids(commands, extent);
}

void RasterImages::copy_ids(const vk::raii::CommandBuffer &commands, vk::Extent2D extent) const {
  ids_->transition(commands, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal,
                   Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite, Stage::eTransfer,
                   Access::eTransferRead);
  const vk::BufferImageCopy region(0, extent.width, extent.height, {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                   {0, 0, 0}, {extent.width, extent.height, 1});
  commands.copyImageToBuffer(ids_->get(), Layout::eTransferSrcOptimal, id_buffer_->get(), region);
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, users_of_ids, uses_of_ids);
}

} // namespace pmdsim
