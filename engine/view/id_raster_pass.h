#pragma once
// The ID raster pass: rasterises the projected triangles and gives every visible sample its pixel ID and
// its triangle ID, nearest wins.

#include "engine/model/simulator_options.h"
#include "engine/sampling/sample_grid.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/projection.h"
#include "engine/view/raster_images.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/compute_pipeline.h"

#include <memory>
#include <optional>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim {

// The largest raster block that the device rasterises exactly: half of its largest power-of-two viewport.
std::uint32_t raster_block_fragments(const vulkan::Device &device);

class IdRasterPass {
public:
  // `strips` tell how large an image is needed; `grid`: given where the samples' records are asked for;
  // `previous`: taken where they are the same. `scene` and `id_buffer` stay where they are.
  IdRasterPass(const vulkan::Device &device, const Projection &projection, const Sensor &sensor,
               const std::vector<PlannedStrip> &strips, const SceneBuffers &scene, SamplePrecision precision,
               const std::optional<ChipGrid> &grid, const vulkan::Buffer &id_buffer,
               std::optional<RasterImages> &&previous);

  // Leaves the IDs of the strip's samples, or their records (shaders/shared/interface.h), or with distortion
  // the IDs of its block's fragments, in the buffer, visible to compute shaders and transfers. If the strip
  // is not one of those planned, only its first row may be right.
  void record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const;

  std::optional<RasterImages> release_images();

private:
  void add_depths(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const;
  void draw(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const;
  void draw_tile(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
                 const glm::uvec2 &tile) const;

  Sensor sensor_;
  const SceneBuffers &scene_;
  const vulkan::Buffer &id_buffer_;
  std::vector<RasterBlock> blocks_;
  vulkan::Buffer vertices_;
  vulkan::Buffer planes_of_blocks_;               // BlockPlane of each where shapes may have holes
  std::optional<RasterImages> images_;            // nothing once released
  std::optional<vulkan::ComputePipeline> depths_; // nothing where the fragments leave all that is asked for
  std::optional<ChipGrid> grid_;
  float half_viewport_;
  std::shared_ptr<const vulkan::Pipeline> compiled_;
};

} // namespace pmdsim
