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

// A tile is 8 blocks of 4 x 2 neighbours. Its samples lie place by place of a block, each place block by
// block, so that a vector holds one place of all blocks.
constexpr int block_wide = 4, block_high = 2, block_samples = block_wide * block_high;
constexpr int blocks_across = tile_side / block_wide,
              tile_blocks = static_cast<int>(shader::tile_samples) / block_samples;

inline int place_of(int x, int y) {
  const int in_block = y % block_high * block_wide + x % block_wide;
  return in_block * tile_blocks + y / block_high * blocks_across + x / block_wide;
}
// The sample's number in the tile, row by row.
inline int number_of(int place) {
  const int in_block = place / tile_blocks, block = place % tile_blocks;
  const int x = block % blocks_across * block_wide + in_block % block_wide,
            y = block / blocks_across * block_high + in_block / block_wide;
  return y * tile_side + x;
}

// In the order of places.
struct TileSamples {
  alignas(64) double exact[3][shader::tile_samples]; // board frame, m
  alignas(64) float point[3][shader::tile_samples];
  alignas(64) float normal[3][shader::tile_samples] = {}; // where some diode may be behind a surface
  alignas(64) std::int32_t own[shader::tile_samples];     // the shape that it sees
  alignas(64) std::int32_t sees[shader::tile_samples];
};

inline void find_normals(const SilhouetteBoard &board, const SampleSource &of, TileSamples &samples) {
  for (std::uint32_t s = 0; s < shader::tile_samples; ++s) {
    const shader::vec4 &plane = of.planes[samples.sees[s] != 0 ? samples.own[s] : 0].plane_hi;
    for (int i = 0; i < 3; ++i) {
      const double *row = board.rotation[i];
      samples.normal[i][s] = static_cast<float>(row[0]) * plane.x + static_cast<float>(row[1]) * plane.y +
                             static_cast<float>(row[2]) * plane.z;
    }
  }
}

inline Sample sample_of(const TileSamples &samples, int place) {
  Sample sample;
  sample.sees = samples.sees[place] != 0;
  sample.own = static_cast<std::uint32_t>(samples.own[place]);
  for (int i = 0; i < 3; ++i) {
    sample.exact[i] = samples.exact[i][place];
    sample.point[i] = samples.point[i][place];
    sample.rest[i] = static_cast<float>(sample.exact[i] - static_cast<double>(sample.point[i]));
    sample.normal[i] = samples.normal[i][place];
  }
  return sample;
}

// Records of tiles lie apart in memory.
inline void fetch_soon(const SampleSource &of, const Place &at) {
  if (at.index + tile_side < of.strip.padded_pixels) {
    const std::byte *record = of.ids + (std::size_t{at.index} + tile_side) * sizeof(shader::uvec4);
    __builtin_prefetch(record);
    __builtin_prefetch(record + 64);
  }
}

// Returns whether any sample sees something.
inline bool find_samples(const SilhouetteBoard &board, const SampleSource &of, std::uint32_t tile,
                         TileSamples &samples, TileBits &bits) {
  constexpr std::uint32_t count = shader::tile_samples;
  const shader::Strip &strip = of.strip;
  const std::uint32_t across = (strip.columns + tile_side - 1) / tile_side,
                      down = (strip.rows + tile_side - 1) / tile_side;
  const std::uint32_t subsample = tile / (across * down), of_subsample = tile % (across * down);
  alignas(64) double column[count], row[count], depth[count], camera[3][count];
  bool any = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    Place at{of_subsample % across * tile_side + i % tile_side,
             of_subsample / across * tile_side + i / tile_side, subsample % strip.samples,
             subsample / strip.samples, 0};
    const int s = place_of(static_cast<int>(i) % tile_side, static_cast<int>(i) / tile_side);
    column[s] = from_middle(strip.column + at.column, strip.resolution_x);
    row[s] = from_middle(strip.row + at.row, strip.resolution_y);
    samples.own[s] = samples.sees[s] = 0;
    depth[s] = camera[0][s] = camera[1][s] = camera[2][s] = 0.0;
    bits.is_there[i] = at.column < strip.columns && at.row < strip.rows;
    bits.sees[i] = false;
    if (!bits.is_there[i])
      continue;
    at.index = bits.index[i] = subsample * strip.padded_pixels + at.row * strip.columns + at.column;
    std::uint32_t own;
    if (of.records) {
      if (i % tile_side == 0)
        fetch_soon(of, at);
      find_record(of, at.index, own, depth[s]);
      bits.sees[i] = depth[s] != 0.0;
    } else {
      double point[3];
      find_point(of, at, point, own);
      for (int k = 0; k < 3; ++k)
        camera[k][s] = point[k];
      bits.sees[i] = point[0] != 0.0 || point[1] != 0.0 || point[2] != 0.0;
    }
    samples.own[s] = static_cast<std::int32_t>(own);
    samples.sees[s] = bits.sees[i];
    any = any || bits.sees[i];
  }
  if (!any)
    return false;
  if (of.records)
    find_points(of, column, row, depth, camera);
  for (int i = 0; i < 3; ++i) {
    const double *to = board.rotation[i], from = board.translation_m[i];
    for (std::uint32_t s = 0; s < count; ++s) {
      samples.exact[i][s] = to[0] * camera[0][s] + to[1] * camera[1][s] + to[2] * camera[2][s] + from;
      samples.point[i][s] = static_cast<float>(samples.exact[i][s]);
    }
  }
  return true;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
