#include "host/input/diagram/diode_across.h"

#include <cmath>

namespace pmdsim {

namespace {

glm::dvec3 without_roll(const glm::dvec3 &axis) {
  const double off_z = axis.x * axis.x + axis.y * axis.y;
  if (off_z == 0.0)
    return {1.0, 0.0, 0.0};
  // 1 / (1 + z), without cancellation near -z.
  const double factor = axis.z >= 0.0 ? 1.0 / (1.0 + axis.z) : (1.0 - axis.z) / off_z;
  const glm::dvec3 across(1.0 - axis.x * axis.x * factor, -axis.x * axis.y * factor, -axis.x);
  return glm::normalize(across - glm::dot(across, axis) * axis);
}

} // namespace

glm::dvec3 diode_across(const glm::dvec3 &axis, double roll_rad) {
  const glm::dvec3 across = without_roll(axis);
  return std::cos(roll_rad) * across + std::sin(roll_rad) * glm::cross(axis, across);
}

} // namespace pmdsim
