#pragma once
// The closed convex bodies of a scene: boxes, balls, cylinders. Such a body does not shade itself, and light
// that it blocks on the way between two points outside leaves it through a triangle whose front it shows to
// where it goes: half of its triangles need not be tried.

#include "engine/model/scene.h"

#include <vector>

namespace pmdsim {

// For each of the scene's triangles the body that it belongs to, or no_id. Convex where no vertex rises over
// any triangle's plane by more than float rounding, relative to the body's size. A triangle that may have
// holes belongs to none.
std::vector<std::uint32_t> convex_bodies(const Scene &scene);

} // namespace pmdsim
