#pragma once
// What the camera measures of one frame. Every channel is row-major, row 0 at the top, rows * columns values.

#include "engine/pass_time.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

struct Measurement {
  glm::uvec2 resolution{0, 0}; // columns, rows

  std::vector<float> amplitude;  // |z|, W/(m^2 sr), 0 where nothing returns
  std::vector<float> phase_rad;  // arg z in [0, 2 pi), NaN where |z| = 0
  std::vector<float> distance_m; // c phase / (4 pi f) in [0, c/(2f)), NaN where |z| = 0
  // Ground truth over the pixel's samples that hit something; NaN where none does.
  std::vector<float> range_m;  // mean distance point - lens
  std::vector<float> z_m;      // mean depth along the optical axis
  std::vector<float> coverage; // samples hit / samples, 0 to 1
  // Of the sample nearest the pixel's centre (ties: up, left); no_id where it hits nothing.
  std::vector<std::uint32_t> triangle_id;
  std::vector<std::uint32_t> object_id;

  // Triangle of every sample, (S*rows) x (S*columns), row-major; only filled on request.
  std::vector<std::uint32_t> sample_triangle_id;

  double frame_ms = 0.0;        // first pass to results in host memory, by the clock
  std::vector<PassTime> passes; // the same by pass
};

} // namespace pmdsim
