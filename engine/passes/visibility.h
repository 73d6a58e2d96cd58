#pragma once
// The visibility pass: rasterises the projected triangles and tags every visible sample with its pixel ID and
// its triangle ID, nearest wins.

#include "engine/passes/strip_buffers.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/image.h"

#include <vulkan/vulkan_raii.hpp>

namespace pmdsim {

// The largest raster block that the device rasterises exactly: half of its largest power-of-two viewport.
std::uint32_t raster_block_samples(const vulkan::Device &device);

class VisibilityPass {
public:
  // `strips` tell how large an image is needed.
  VisibilityPass(const vulkan::Device &device, const Projection &projection,
                 const std::vector<PlannedStrip> &strips);

  // Leaves the strip's tags in `buffers.tags`, visible to compute shaders and transfers.
  void record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
              const StripBuffers &buffers) const;

private:
  void draw(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const;
  void copy_tags(const vk::raii::CommandBuffer &commands, vk::Extent2D extent,
                 const StripBuffers &buffers) const;

  std::vector<RasterBlock> blocks_;
  vulkan::Buffer vertices_;
  vulkan::Image tags_;
  vulkan::Image depth_;
  float half_viewport_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
};

} // namespace pmdsim
