#pragma once
// What may stand between diodes and what the lens sees, the hierarchy over it, and which of it is convex.

#include "engine/light/camera_light.h"
#include "shaders/shadow/lit_interface.h"

#include <vector>

namespace pmdsim {

// A shape whose plane has all diodes and all that the lens sees on one side never blocks and is left out: the
// walls of a room, a single wall.
struct Occluders {
  std::vector<shader::Occluder> shapes; // in the order of camera.triangles, then camera.hidden
  std::vector<std::uint32_t> bodies;    // for each of the scene's shapes its convex body, or no_id
};

// Convex bodies whose box meets that around the lens and all diodes do not count as such.
Occluders find_occluders(const CameraScene &camera, const Scene &scene,
                         const std::vector<CameraIlluminator> &illuminators);

// The bounding volume hierarchy over the occluders, laid out in the order of a walk that needs no stack.
struct OccluderTree {
  std::vector<shader::TreeNode> nodes;
  std::vector<shader::Occluder> occluders; // in the order of the leaves
};

// Throws Error (out_of_memory).
OccluderTree build_tree(const std::vector<shader::Occluder> &occluders);

// For each of the scene's triangles the closed convex body that it belongs to (boxes, balls, cylinders), or
// no_id. Convex where no vertex rises over any triangle's plane by more than float rounding, relative to the
// body's size. A triangle that may have holes belongs to none. A body does not shade itself, and light that
// it blocks on the way between two points outside leaves it through a triangle whose front it shows to where
// it goes: half of its triangles need not be tried.
std::vector<std::uint32_t> convex_bodies(const Scene &scene);

} // namespace pmdsim
