#pragma once
// A measure of angles that needs no trigonometry.

#include <cmath>
#include <glm/glm.hpp>

namespace pmdsim {

// Grows with the angle of (x, y) about the origin, from 0 to 4.
inline float turn_of(const glm::vec2 &q) {
  const float size = std::abs(q.x) + std::abs(q.y);
  const float t = size > 0.0f ? q.y / size : 0.0f;
  return q.x < 0.0f ? 2.0f - t : q.y < 0.0f ? 4.0f + t : t;
}

} // namespace pmdsim
