#pragma once
// What may stand between diodes and what the lens sees. A shape whose plane has them all on one side never
// does and is left out: the walls of a room, a single wall.

#include "engine/light/camera_light.h"
#include "shaders/shadow/lit_interface.h"

#include <vector>

namespace pmdsim {

struct Occluders {
  std::vector<shader::Occluder> shapes; // in the order of camera.triangles, then camera.hidden
  std::vector<std::uint32_t> bodies;    // for each of the scene's shapes its convex body, or no_id
};

// Convex bodies whose box meets that around the lens and all diodes do not count as such.
Occluders find_occluders(const CameraScene &camera, const Scene &scene,
                         const std::vector<CameraIlluminator> &illuminators);

} // namespace pmdsim
