#pragma once
// The shapes that may stand between diodes and what the lens sees.

#include "engine/light/camera_light.h"
#include "shaders/shadow/occluder.h"

#include <vector>

namespace pmdsim {

// A shape whose plane has all diodes and all that the lens sees on one side never blocks and is left out: the
// walls of a room, a single wall. In the order of camera.triangles, then camera.hidden.
struct Occluders {
  std::vector<shader::Occluder> shapes;     // triangles without holes: light that meets them is blocked
  std::vector<shader::Occluder> with_holes; // triangles that a mask cuts out, and those around discs

  bool empty() const { return shapes.empty() && with_holes.empty(); }
};

Occluders find_occluders(const CameraScene &camera, const Scene &scene,
                         const std::vector<CameraIlluminator> &illuminators);

} // namespace pmdsim
