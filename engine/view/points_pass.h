#pragma once
// The passes that find for every sample the point of the scene that it sees.

#include "engine/model/simulator_options.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"

#include <vector>

namespace pmdsim {

// From the sample's triangle's plane and its exact ray, for sensors without distortion; of the pixels of
// `list`, or of all. `surface_vectors`: of normals and heights, that the sum asks for a sample (SumModel).
Pass points_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                 std::uint32_t surface_vectors, const StripBuffers &buffers, const SceneBuffers &scene,
                 const vulkan::Buffer *list = nullptr);

// The lens search, which stands for the points pass where the lens distorts: for every sample its exact ray,
// by the inverse lens model, and the nearest triangle that the fragments around it see. The planes of
// `scene_buffers` have ranges along the ray.
Pass lens_search_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                      const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
                      std::uint32_t surface_vectors, const StripBuffers &buffers,
                      const SceneBuffers &scene_buffers);

} // namespace pmdsim
