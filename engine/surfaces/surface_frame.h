#pragma once
// Coordinates about a place on a surface: x and y in it, z along its normal.

#include "engine/surfaces/elements.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pmdsim {

struct SurfaceFrame {
  glm::dvec3 from_m, x, y, z;

  // x is turned about the normal by `turn` of half a turn.
  SurfaceFrame(const SurfacePlace &place, double turn) : from_m(place.position_m), z(place.normal) {
    const glm::dvec3 aside = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(aside, z)), along = glm::cross(z, across);
    const double angle = std::numbers::pi * turn;
    x = std::cos(angle) * across + std::sin(angle) * along;
    y = glm::cross(z, x);
  }
};

// Twice the area between two places of a plane and its origin; positive counter-clockwise.
inline float cross(const glm::vec2 &a, const glm::vec2 &b) { return a.x * b.y - a.y * b.x; }

// The angle of the direction (x, y), y >= 0, from the axis of x, to 1e-6 rad.
inline float angle_of(float x, float y) {
  constexpr auto pi = std::numbers::pi_v<float>;
  const float wide = std::abs(x), low = std::min(wide, y), high = std::max(wide, y);
  const float t = low / std::max(high, std::numeric_limits<float>::min()), q = t * t;
  // The arc tangent of 0 to 1, by least squares.
  const float angle =
      t * (0.99997726f +
           q * (-0.33262347f + q * (0.19354346f + q * (-0.11643287f + q * (0.05265332f - 0.01172120f * q)))));
  const float steep = y > wide ? 0.5f * pi - angle : angle;
  return x < 0.0f ? pi - steep : steep;
}

} // namespace pmdsim
