#pragma once
// What a setup most probably does not mean: lengths of another unit, light that goes nowhere, and lenses and
// diodes within bodies.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"
#include "host/input/setup/setup.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// Of a setup at its start, whose document is `root`. A few milliseconds for 100,000 triangles.
std::vector<Warning> implausibilities(const Setup &setup, const Place &root);

// Light beside a lens that moves away from it while the light stays where it is.
std::vector<Warning> light_left_behind(const Setup &setup, const Place &root);

// Which object each of the points lies inside of, no_id for none: an object whose triangles close around it,
// with their fronts outside. A room, whose walls show their fronts inside, is none; one whose walls show both
// sides is none either where its bounding box is larger than `largest_m` along some axis, as a body seldom
// is.
std::vector<std::uint32_t> bodies_around(const Scene &scene, const std::vector<glm::dvec3> &points_m,
                                         double largest_m);

} // namespace pmdsim
