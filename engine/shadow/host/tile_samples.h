#pragma once
// A tile's samples, from what the device has left of them.

#include "engine/shadow/host/silhouettes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

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

inline double real_at(const std::byte *from, bool has_fp64) {
  if (has_fp64) {
    double value;
    std::memcpy(&value, from, sizeof(value));
    return value;
  }
  float pair[2];
  std::memcpy(pair, from, sizeof(pair));
  return static_cast<double>(pair[0]) + static_cast<double>(pair[1]);
}

// The ray (x, y, 1) of a depth record; `place` in half samples from the frame's middle.
inline void find_ray(const SampleSource &of, double column, double row, double (&ray)[2]) {
  if (!of.chip) {
    ray[0] = column * of.slope[0];
    ray[1] = row * of.slope[1];
    return;
  }
  const shader::ChipPlace &chip = *of.chip;
  double at[3];
  for (int i = 0; i < 3; ++i) {
    const auto of_pair = [i](const shader::vec4 &hi, const shader::vec4 &lo) {
      return static_cast<double>(hi[i]) + static_cast<double>(lo[i]);
    };
    at[i] = of_pair(chip.origin_hi, chip.origin_lo) +
            column * of_pair(chip.half_step_x_hi, chip.half_step_x_lo) +
            row * of_pair(chip.half_step_y_hi, chip.half_step_y_lo);
  }
  ray[0] = at[0] / at[2];
  ray[1] = at[1] / at[2];
}

struct Place {
  std::uint32_t column, row; // in the strip
  std::uint32_t subsample_x, subsample_y;
  std::uint32_t index;
};

// Camera frame, m; 0 where it sees nothing.
inline void find_point(const SampleSource &of, const Place &at, double (&point)[3], std::uint32_t &shape) {
  const shader::Strip &strip = of.strip;
  if (!of.records) {
    for (std::size_t i = 0; i < 3; ++i)
      point[i] = real_at(of.position + (std::size_t{3} * at.index + i) * sizeof(double), of.has_fp64);
    const std::size_t columns = strip.columns, samples = strip.samples;
    const std::size_t x =
        of.tiled ? at.subsample_x * columns + at.column : at.column * samples + at.subsample_x;
    const std::size_t y =
        of.tiled ? at.subsample_y * std::size_t{strip.rows} + at.row : at.row * samples + at.subsample_y;
    std::memcpy(&shape, of.ids + (y * columns * samples + x) * sizeof(shader::uvec2) + 4, sizeof(shape));
    return;
  }
  const std::byte *record = of.ids + std::size_t{at.index} * sizeof(shader::uvec4);
  std::memcpy(&shape, record + 4, sizeof(shape));
  const double depth = real_at(record + 8, of.has_fp64);
  double ray[2];
  find_ray(of, 2.0 * (strip.column + at.column) + 1.0 - strip.resolution_x,
           2.0 * (strip.row + at.row) + 1.0 - strip.resolution_y, ray);
  point[0] = ray[0] * depth;
  point[1] = ray[1] * depth;
  point[2] = depth;
}

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
