#pragma once
// The points pass: for every sample the point of the scene that it sees, from its triangle's plane and its
// exact ray. For sensors without distortion.

#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

namespace pmdsim {

class PointsPass {
public:
  // `surface_vectors`: of normals and heights, that the sum asks for a sample (SumModel); `listed`: only of
  // lists of pixels.
  PointsPass(const vulkan::Device &device, const Sensor &sensor, std::uint32_t surface_vectors, bool painted,
             SamplePrecision precision, bool listed = false);

  // `scene.planes` holds the TrianglePlane of each of the scene's triangles.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const SceneBuffers &scene,
              const vulkan::Buffer *list = nullptr) const;

private:
  shader::vec4 slope_;
  vulkan::Buffer chip_;
  vulkan::ComputePipeline pipeline_;
};

} // namespace pmdsim
