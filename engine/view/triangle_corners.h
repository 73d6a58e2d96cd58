#pragma once
// The visible triangles as the search pass walks over them.

#include "engine/view/camera_scene.h"

namespace pmdsim {

// Corners and neighbours, one record for each of the scene's triangles; those that the lens cannot see are
// zero and nobody's neighbours. Edges are shared where both ends have the same coordinates.
std::vector<shader::TriangleCorners> triangle_corners(const CameraScene &camera, const Scene &scene);

} // namespace pmdsim
