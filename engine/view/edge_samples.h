#pragma once
// Samples without distortion that lie so near to a triangle's edge that the raster's grid, to which corners
// are snapped, may decide them the wrong way; and what each of them sees, decided from its exact ray.

#include "engine/sampling/raster_blocks.h"
#include "engine/view/camera_scene.h"
#include "shaders/shared/interface.h"

#include <cstdint>
#include <vector>

namespace pmdsim {

struct EdgeSamples {
  std::vector<shader::EdgeSample> samples; // block after block, each by its rows of pixels
  std::vector<std::uint32_t> end_of_block; // in `samples`
};

// Samples that would see a surface with holes are left to the raster, which knows the holes.
EdgeSamples find_edge_samples(const CameraScene &camera, const Scene &scene, const Sensor &sensor,
                              const std::vector<RasterBlock> &blocks);

} // namespace pmdsim
