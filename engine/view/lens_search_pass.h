#pragma once
// The search pass, which stands for the points pass where the lens distorts: for every sample its exact ray,
// by the inverse lens model, and the nearest triangle that the fragments around it see.

#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/strip_memory.h"
#include "engine/view/camera_scene.h"
#include "engine/view/surface_appearance.h"
#include "engine/vulkan/compute_pipeline.h"

namespace pmdsim {

class SearchPass {
public:
  // `surface_vectors`: of normals and heights, that the sum asks for a sample (SumModel); `paint` tells
  // whether shapes have any.
  SearchPass(const vulkan::Device &device, const Sensor &sensor, const CameraScene &camera,
             const Scene &scene, const std::vector<RasterBlock> &blocks, std::uint32_t surface_vectors,
             const PaintBuffers &paint, SamplePrecision precision);

  // `scene.planes` holds the TrianglePlane of each of the scene's triangles, with ranges along the ray.
  void record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
              const StripBuffers &buffers, const SceneBuffers &scene) const;

private:
  vulkan::Buffer lens_;
  vulkan::Buffer views_; // RasterView of each block
  vulkan::Buffer corners_;
  vulkan::ComputePipeline pipeline_;
};

} // namespace pmdsim
