#pragma once
// The raster of IDs on the host, for devices that are its processor: it leaves the same bits as IdRasterPass
// and EdgeSettling, straight in the memory that both share.

#include "engine/model/scene.h"
#include "engine/sampling/sample_grid.h"
#include "engine/view/camera_scene.h"
#include "engine/view/edge_samples.h"
#include "engine/view/host/raster_kernel.h"
#include "engine/view/projection.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/buffer.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim {

class HostRaster {
public:
  // For a sensor whose fragments are samples, and a scene without holes, on a device that has doubles.
  // `grid`: given where the samples' records are asked for. `scene` and `id_buffer`, whose memory the host
  // shares, stay where they are. `most_bits`: of vectors.
  HostRaster(const Projection &projection, const Sensor &sensor, const CameraScene &camera,
             const Scene &scene, const SceneBuffers &on_device, const std::optional<ChipGrid> &grid,
             const vulkan::Buffer &id_buffer, std::uint32_t most_bits);

  // Leaves the IDs of the strip's samples, or their records, in the buffer.
  void draw(const PlannedStrip &planned) const;

private:
  // Triangles of a raster block that cover any sample, and which of them each of its bands of rows meets.
  struct Block {
    glm::uvec2 first_pixel;
    std::vector<BlockTriangle> triangles;
    std::vector<std::uint32_t> listed;      // band by band, in the order of the triangles
    std::vector<std::size_t> begin_of_band; // in `listed`, and the end
  };
  static Block block_of(const Projection &projection, const RasterBlock &of);
  void draw_band(const PlannedStrip &planned, const BandSamples &to, std::uint32_t band) const;
  void settle(const PlannedStrip &planned, const BandRows &band) const;

  std::vector<Block> blocks_;
  EdgeSamples edges_;
  const SceneBuffers &scene_;
  std::optional<ChipGrid> grid_;
  const vulkan::Buffer &id_buffer_;
  std::uint32_t samples_; // of a pixel, along either axis
  const RasterKernel *kernel_;
};

} // namespace pmdsim
