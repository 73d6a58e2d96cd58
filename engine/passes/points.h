#pragma once
// The points pass: for every sample the point of the scene that it sees, from its triangle's plane and its
// exact ray. For sensors without distortion.

#include "engine/passes/scene_buffers.h"
#include "engine/passes/strip_buffers.h"
#include "engine/sensor.h"
#include "engine/simulator_options.h"
#include "engine/vulkan/compute_pipeline.h"

namespace pmdsim {

class PointsPass {
public:
  // `surface_vectors`: of normals and heights, that the sum asks for a sample (SumModel).
  PointsPass(const vulkan::Device &device, const Sensor &sensor, std::uint32_t surface_vectors, bool painted,
             SamplePrecision precision);

  // `scene.planes` holds the TrianglePlane of each of the scene's triangles.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const SceneBuffers &scene) const;

private:
  shader::vec4 slope_;
  vulkan::Buffer chip_;
  vulkan::ComputePipeline pipeline_;
};

} // namespace pmdsim
