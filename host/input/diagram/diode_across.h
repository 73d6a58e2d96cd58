#pragma once
// Where the angle about a diode's axis begins.

#include <glm/glm.hpp>

namespace pmdsim {

// Diode::across: the illuminator's +x, carried along by the smallest rotation that takes +z to the axis (for
// -z: half a turn about x), then turned by `roll_rad`, right-handed about the axis. `axis` has unit length.
glm::dvec3 diode_across(const glm::dvec3 &axis, double roll_rad);

} // namespace pmdsim
