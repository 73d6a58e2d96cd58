#pragma once
// A sample's point, from what the device has left of it.

#include "engine/sampling/host/sample_source.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

struct Place {
  std::uint32_t column, row; // in the strip
  std::uint32_t subsample_x, subsample_y;
  std::uint32_t index;
};

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

// The ray (x, y, 1) of a sample of an even grid, as in shaders/sampling/chip.glsl: `column` and `row` in half
// samples from the frame's middle, `place` where the chip is not nominal, else `slope`.
inline void find_ray(const shader::ChipPlace *place, const double (&slope)[2], double column, double row,
                     double (&ray)[2]) {
  if (!place) {
    ray[0] = column * slope[0];
    ray[1] = row * slope[1];
    return;
  }
  const shader::ChipPlace &chip = *place;
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

// From the frame's middle, in half samples; `place` and `extent` are a column or a row and their number.
inline double from_middle(std::uint32_t place, std::uint32_t extent) {
  return 2.0 * static_cast<double>(place) + 1.0 - static_cast<double>(extent);
}

// Of a depth record.
inline void find_record(const SampleSource &of, std::size_t index, std::uint32_t &shape, double &depth) {
  const std::byte *record = of.ids + index * sizeof(shader::uvec4);
  std::memcpy(&shape, record + 4, sizeof(shape));
  depth = real_at(record + 8, of.has_fp64);
}

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
  double depth;
  find_record(of, at.index, shape, depth);
  double ray[2];
  find_ray(of.chip, of.slope, from_middle(strip.column + at.column, strip.resolution_x),
           from_middle(strip.row + at.row, strip.resolution_y), ray);
  point[0] = ray[0] * depth;
  point[1] = ray[1] * depth;
  point[2] = depth;
}

// The points of several depth records: `column` and `row` as in find_ray, `depth` in m, 0 where nothing is
// seen.
template <std::size_t count>
void find_points(const SampleSource &of, double (&column)[count], double (&row)[count],
                 const double (&depth)[count], double (&point)[3][count]) {
  for (std::size_t i = 0; i < count && of.chip; ++i) {
    double ray[2];
    find_ray(of.chip, of.slope, column[i], row[i], ray);
    column[i] = ray[0];
    row[i] = ray[1];
  }
  const double slope_x = of.chip ? 1.0 : of.slope[0], slope_y = of.chip ? 1.0 : of.slope[1];
  for (std::size_t i = 0; i < count; ++i) {
    point[0][i] = column[i] * slope_x * depth[i];
    point[1][i] = row[i] * slope_y * depth[i];
    point[2][i] = depth[i];
  }
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
