#pragma once
// What the passes look up about the scene, by a shape's id.

#include "engine/view/surface_appearance.h"

#include <optional>

namespace pmdsim {

struct SceneBuffers {
  vulkan::Buffer planes; // TrianglePlane of each of the scene's shapes
  PaintBuffers paint;
  std::optional<float> backscatter; // TrianglePlane's, where all that the lens can see has the same
  double world_rounding_m;          // as in CameraScene
};

} // namespace pmdsim
