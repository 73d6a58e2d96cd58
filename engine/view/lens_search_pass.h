#pragma once
// The pass that finds for every sample the point of the scene that it sees through a lens with distortion.

#include "engine/model/simulator_options.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"

#include <vector>

namespace pmdsim {

// The lens search, which stands for the points pass where the lens distorts: for every sample its exact ray,
// by the inverse lens model, and the nearest triangle that the fragments around it see. The planes of
// `scene_buffers` have ranges along the ray.
Pass lens_search_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                      const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
                      std::uint32_t surface_vectors, const StripBuffers &buffers,
                      const SceneBuffers &scene_buffers);

} // namespace pmdsim
