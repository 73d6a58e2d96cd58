#pragma once
// Ranges of an image's pixels, and what they depend on.

#include <glm/glm.hpp>
#include <span>

namespace pmdsim {

// Row-major, rows * columns values, which outlive it.
struct RangeImage {
  glm::uvec2 resolution;                // columns, rows
  std::span<const glm::dvec3> ray;      // unit length, camera frame
  std::span<const double> range_m;      // not finite where there is none
  std::span<const glm::dvec3> normal{}; // for which the ranges were found
  // How a range changes with its normal, m for each unit; empty: not at all.
  std::span<const glm::dvec3> per_normal_m{};
  double noise_m = 0.0; // of ranges: what a plane may be off
  // The normals are no more than a guess.
  bool normals_guessed = false;
};

} // namespace pmdsim
