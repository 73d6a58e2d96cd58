#pragma once
// Directions and rotations out of what files say, which is not quite one.

#include <glm/glm.hpp>
#include <optional>

namespace pmdsim {

// Directions closer than this, in radians, count as parallel.
inline constexpr double smallest_sine = 1e-9;

// Unit vector along `v`; nothing where `v` has no direction. Free of overflow and underflow.
std::optional<glm::dvec3> direction_of(const glm::dvec3 &v);

// The rotation nearest in spirit to a linear map: z, the view axis, is kept, y is turned only as far as shear
// requires. Nothing where the map is mirrored or singular.
std::optional<glm::dmat3> rotation_of(const glm::dmat3 &linear);

} // namespace pmdsim
