#include "host/input/setup/rotations.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {

std::optional<glm::dvec3> direction_of(const glm::dvec3 &v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0) || !std::isfinite(largest))
    return std::nullopt;
  return glm::normalize(v / largest);
}

std::optional<glm::dmat3> rotation_of(const glm::dmat3 &linear) {
  const auto z = direction_of(linear[2]);
  const auto y_sheared = direction_of(linear[1]);
  const auto x_sheared = direction_of(linear[0]);
  if (!x_sheared || !y_sheared || !z)
    return std::nullopt;
  const glm::dvec3 y = *y_sheared - glm::dot(*y_sheared, *z) * *z;
  if (glm::length(y) < smallest_sine ||
      glm::determinant(glm::dmat3(*x_sheared, *y_sheared, *z)) < smallest_sine)
    return std::nullopt;
  const glm::dvec3 y_unit = glm::normalize(y);
  return glm::dmat3(glm::cross(y_unit, *z), y_unit, *z);
}

} // namespace pmdsim
