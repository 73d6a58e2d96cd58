#pragma once
// How the scene's shapes are painted, as the shaders read it; empty where nothing is.

#include "engine/passes/camera_scene.h"
#include "engine/vulkan/buffer.h"

#include <vector>

namespace pmdsim {

struct PaintBuffers {
  vulkan::Buffer shapes;   // ShapePaint of each of the scene's shapes
  vulkan::Buffer surfaces; // SurfacePaint of each of its surfaces
  std::vector<vulkan::Buffer> textures;
  bool painted = false; // whether any shape that the lens can see is; else all else is empty
  bool masked = false;  // whether any may have holes, or is a disc
};

PaintBuffers upload_paint(const vulkan::Device &device, const CameraScene &camera, const Scene &scene,
                          Backscatter backscatter);

// ShapePaint::origin of each shape and the affine functions, by the shape's id.
std::vector<shader::ShapePaint> shape_paints(const CameraScene &camera, const Scene &scene);

} // namespace pmdsim
