#pragma once
// The points pass: for every sample the point of the scene that it sees, from its triangle's plane and its
// exact ray. For sensors without distortion.

#include "engine/model/simulator_options.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"

namespace pmdsim {

// `surface_vectors`: of normals and heights, that the sum asks for a sample (SumModel); of the pixels of
// `list`, or of all.
Pass points_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                 std::uint32_t surface_vectors, const StripBuffers &buffers, const SceneBuffers &scene,
                 const vulkan::Buffer *list = nullptr);

} // namespace pmdsim
