#pragma once
// The pass that finds for every sample the point of the scene that it sees, where the lens does not bend
// lines.

#include "engine/model/simulator_options.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"

#include <vector>

namespace pmdsim {

// Finds points from the plane of a sample's triangle and its exact ray, for sensors without distortion; for
// the pixels of `list`, or for all. `surface_vectors`: those of normals and heights that the sum asks for a
// sample (SumModel).
Pass points_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                 std::uint32_t surface_vectors, const StripBuffers &buffers, const SceneBuffers &scene,
                 const vulkan::Buffer *list = nullptr);

} // namespace pmdsim
