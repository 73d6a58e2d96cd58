#pragma once
// Directions above a surface, chosen so that each stands for the same share of the light that arrives: the
// unit square is taken to the disc without changing areas (P. Shirley and K. Chiu, "A low distortion map
// between disk and square", Journal of Graphics Tools 2, 1997), and the disc is the hemisphere seen from
// above (W. Nusselt, "Graphische Bestimmung des Winkelverhältnisses bei der Wärmestrahlung", 1928).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace pmdsim {

// The square cut into edge * edge equal cells, one direction each; `edge` is even. The cells lie in square
// rings around the middle, which become rings of the disc. A direction has the mean height of its ring, so
// that functions linear in the height are summed exactly: at the horizon, where the height changes fastest,
// the middle of a cell would be off most.
class Hemisphere {
public:
  // About `normal`, turned about it by `turn` of a whole turn.
  Hemisphere(const glm::dvec3 &normal, double turn, std::uint32_t edge) : half_(edge / 2) {
    const glm::dvec3 aside = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(aside, normal)), along = glm::cross(normal, across);
    const double angle = 2.0 * std::numbers::pi * turn, c = std::cos(angle), s = std::sin(angle);
    x_ = glm::vec3(c * across + s * along);
    y_ = glm::vec3(c * along - s * across);
    z_ = glm::vec3(normal);
    for (std::uint32_t ring = 0; ring < half_; ++ring) {
      const double inner = height_at(ring), outer = height_at(ring + 1);
      const double mean = 2.0 / 3.0 * (inner * inner + inner * outer + outer * outer) / (inner + outer);
      const double deviation = std::sqrt(std::max(0.0, 0.5 * (inner * inner + outer * outer) - mean * mean));
      for (const double height : {mean - deviation, mean + deviation})
        rings_.push_back({static_cast<float>(std::sqrt(1.0 - height * height)), static_cast<float>(height)});
    }
  }

  // Unit length; neighbouring cells are neighbouring directions.
  glm::vec3 direction(const glm::uvec2 &cell) const {
    // From the middle, in half cells: odd numbers.
    const int a = 2 * static_cast<int>(cell.x) + 1 - 2 * static_cast<int>(half_),
              b = 2 * static_cast<int>(cell.y) + 1 - 2 * static_cast<int>(half_);
    const bool wide = std::abs(a) > std::abs(b);
    const int outward = wide ? a : b;
    const Ring &ring = rings_[static_cast<std::uint32_t>(std::abs(outward)) / 2 * 2 + (cell.x + cell.y) % 2];
    constexpr auto eighth = static_cast<float>(std::numbers::pi / 4.0);
    const float angle = eighth * static_cast<float>(wide ? b : a) / static_cast<float>(outward),
                u = angle * angle;
    // Sine and cosine of up to an eighth of a turn, to 1e-7.
    const float s = angle * (1.0f + u * (-1.0f / 6 + u * (1.0f / 120 - u / 5040)));
    const float c = 1.0f + u * (-0.5f + u * (1.0f / 24 + u * (-1.0f / 720 + u / 40320)));
    const float radius = outward > 0 ? ring.radius : -ring.radius;
    return (wide ? radius * c : radius * s) * x_ + (wide ? radius * s : radius * c) * y_ + ring.height * z_;
  }

private:
  struct Ring {
    float radius, height;
  };

  // On the sphere above the border between two rings.
  double height_at(std::uint32_t ring) const {
    const double radius = static_cast<double>(ring) / half_;
    return std::sqrt(1.0 - radius * radius);
  }

  std::uint32_t half_; // of the edge
  glm::vec3 x_, y_, z_;
  std::vector<Ring> rings_; // from the middle, the low and the high one of each
};

// A turn of directions for the place with that number, far from those of its neighbours (the golden ratio's
// sequence).
inline double turn_of(std::uint64_t number) {
  const double turns = 0.61803398874989484820 * static_cast<double>(number % 1'000'003);
  return turns - std::floor(turns);
}

} // namespace pmdsim
