#pragma once
// A tile's samples, from what the device has left of them.

#include "engine/sampling/host/sample_points.h"
#include "engine/shadow/host/silhouettes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

constexpr int tile_side = shader::tile_side;

// Board frame, m.
struct Sample {
  bool sees;
  std::uint32_t own; // the shape that it sees
  double exact[3];
  float point[3], rest[3], normal[3];
};

inline float sum_of_sizes(const float (&v)[3]) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

inline void find_sample(const SilhouetteBoard &board, const SampleSource &of, const Place &at,
                        Sample &sample) {
  double camera[3];
  find_point(of, at, camera, sample.own);
  sample.sees = camera[0] != 0.0 || camera[1] != 0.0 || camera[2] != 0.0;
  if (!sample.sees)
    return;
  const shader::vec4 &plane = of.planes[sample.own].plane_hi;
  for (int i = 0; i < 3; ++i) {
    const double *row = board.rotation[i];
    sample.exact[i] = row[0] * camera[0] + row[1] * camera[1] + row[2] * camera[2] + board.translation_m[i];
    sample.point[i] = static_cast<float>(sample.exact[i]);
    sample.rest[i] = static_cast<float>(sample.exact[i] - static_cast<double>(sample.point[i]));
    sample.normal[i] = static_cast<float>(row[0]) * plane.x + static_cast<float>(row[1]) * plane.y +
                       static_cast<float>(row[2]) * plane.z;
  }
}

// Returns whether any sample sees something.
inline bool find_samples(const SilhouetteBoard &board, const SampleSource &of, std::uint32_t tile,
                         Sample *samples, TileBits &bits) {
  const shader::Strip &strip = of.strip;
  const std::uint32_t across = (strip.columns + tile_side - 1) / tile_side,
                      down = (strip.rows + tile_side - 1) / tile_side;
  const std::uint32_t subsample = tile / (across * down), of_subsample = tile % (across * down);
  bool any = false;
  for (std::uint32_t i = 0; i < shader::tile_samples; ++i) {
    Place at{of_subsample % across * tile_side + i % tile_side,
             of_subsample / across * tile_side + i / tile_side, subsample % strip.samples,
             subsample / strip.samples, 0};
    bits.is_there[i] = at.column < strip.columns && at.row < strip.rows;
    samples[i].sees = bits.sees[i] = false;
    if (!bits.is_there[i])
      continue;
    at.index = subsample * strip.padded_pixels + at.row * strip.columns + at.column;
    bits.index[i] = at.index;
    find_sample(board, of, at, samples[i]);
    bits.sees[i] = samples[i].sees;
    any = any || samples[i].sees;
  }
  return any;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
