#pragma once
// Tests of what may lie between some samples and the board, by half-spaces that hold all ways from there.

#include "engine/model/lanes.h"
#include "engine/shadow/host/tile_samples.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

constexpr float diagonal = 0.70710678f;
constexpr float slack_m = 1e-5f; // rounding of what lies on a shaft's side

// The supports of a point along the eight directions.
inline void along_directions(const float *p, float (&along)[8]) {
  const float u = diagonal * (p[0] + p[1]), v = diagonal * (p[0] - p[1]);
  along[0] = p[0], along[1] = -p[0], along[2] = p[1], along[3] = -p[1];
  along[4] = u, along[5] = -u, along[6] = v, along[7] = -v;
}

// All ways from some samples to the board: u . xy + k z <= s for eight directions u.
struct Ways {
  float slopes[8], supports[8];
  float low[3], high[3]; // box of the samples
  float farthest, highest;
};

// The bounds that a set of samples keeps within.
struct Shaft {
  float slopes[8], sights[8]; // of the ways to the board, and to the lens
  float low[3], high[3];
  bool in_front, any;
};

inline bool may_turn_away(const Sample &sample, const SilhouetteBoard &board) {
  const float *n = sample.normal, *p = sample.point;
  const float across = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  const float up = n[2] * (n[2] > 0.0f ? board.diodes_low : board.diodes_high);
  const float lowest = up - (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) - 1.00001f * board.radius * across;
  return lowest < 1e-6f * (sum_of_sizes(sample.point) + board.radius);
}

// The same of any sample of a tile.
inline bool may_turn_away(const TileSamples &samples, const SilhouetteBoard &board) {
  Ints turns{};
  for (std::size_t s = 0; s < shader::tile_samples; s += lanes) {
    const Floats n[3] = {load<Floats>(samples.normal[0] + s), load<Floats>(samples.normal[1] + s),
                         load<Floats>(samples.normal[2] + s)},
                 p[3] = {load<Floats>(samples.point[0] + s), load<Floats>(samples.point[1] + s),
                         load<Floats>(samples.point[2] + s)};
    const Floats across = 1.000001f * root(n[0] * n[0] + n[1] * n[1] + 1e-30f);
    const Floats up = n[2] * (n[2] > 0.0f ? all(board.diodes_low) : all(board.diodes_high));
    const Floats lowest = up - (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) - 1.00001f * board.radius * across;
    const Floats size = absolute(p[0]) + absolute(p[1]) + absolute(p[2]);
    turns |= (lowest < 1e-6f * (size + board.radius)) & (load<Ints>(samples.sees + s) != 0);
  }
  return bits_of(turns) != 0;
}

inline Shaft no_shaft() {
  Shaft shaft{};
  for (int i = 0; i < 8; ++i)
    shaft.slopes[i] = shaft.sights[i] = -1e9f;
  for (int i = 0; i < 3; ++i)
    shaft.low[i] = 1e9f, shaft.high[i] = -1e9f;
  shaft.in_front = true;
  return shaft;
}

inline void add_sample(const Sample &sample, const SilhouetteBoard &board, Shaft &shaft) {
  float along[8];
  along_directions(sample.point, along);
  const float z = sample.point[2], per_depth = 1.0f / (-z > 1e-6f ? -z : 1e-6f),
              per_sight = 1.0f / (board.lens_z - z);
  for (int i = 0; i < 8; ++i) {
    const float slope = (along[i] - board.supports[i]) * per_depth, sight = along[i] * per_sight;
    shaft.slopes[i] = slope > shaft.slopes[i] ? slope : shaft.slopes[i];
    shaft.sights[i] = sight > shaft.sights[i] ? sight : shaft.sights[i];
  }
  for (int i = 0; i < 3; ++i) {
    shaft.low[i] = sample.point[i] < shaft.low[i] ? sample.point[i] : shaft.low[i];
    shaft.high[i] = sample.point[i] > shaft.high[i] ? sample.point[i] : shaft.high[i];
  }
  shaft.in_front = shaft.in_front && z < board.nearest;
  shaft.any = true;
}

inline void add_shaft(const Shaft &of, Shaft &to) {
  for (int k = 0; k < 8; ++k) {
    to.slopes[k] = of.slopes[k] > to.slopes[k] ? of.slopes[k] : to.slopes[k];
    to.sights[k] = of.sights[k] > to.sights[k] ? of.sights[k] : to.sights[k];
  }
  for (int k = 0; k < 3; ++k) {
    to.low[k] = of.low[k] < to.low[k] ? of.low[k] : to.low[k];
    to.high[k] = of.high[k] > to.high[k] ? of.high[k] : to.high[k];
  }
  to.in_front = to.in_front && of.in_front;
  to.any = to.any || of.any;
}

// The shafts of a tile's blocks, by vectors of all blocks; returns that of the tile.
inline Shaft find_shafts(const TileSamples &samples, const SilhouetteBoard &board,
                         Shaft (&of_blocks)[tile_blocks]) {
  constexpr std::size_t count = shader::tile_samples, directions = 8;
  alignas(64) float slopes[directions][count], sights[directions][count], low[3][count], high[3][count];
  for (std::size_t s = 0; s < count; s += lanes) {
    const Floats x = load<Floats>(samples.point[0] + s), y = load<Floats>(samples.point[1] + s),
                 z = load<Floats>(samples.point[2] + s);
    const Ints sees = load<Ints>(samples.sees + s) != 0;
    const Floats u = diagonal * (x + y), v = diagonal * (x - y),
                 along[directions] = {x, -x, y, -y, u, -u, v, -v};
    const Floats per_depth = 1.0f / larger(-z, all(1e-6f)), per_sight = 1.0f / (board.lens_z - z);
    for (std::size_t k = 0; k < directions; ++k) {
      store(slopes[k] + s, sees ? (along[k] - board.supports[k]) * per_depth : all(-1e9f));
      store(sights[k] + s, sees ? along[k] * per_sight : all(-1e9f));
    }
    const Floats at[3] = {x, y, z};
    for (std::size_t k = 0; k < 3; ++k) {
      store(low[k] + s, sees ? at[k] : all(1e9f));
      store(high[k] + s, sees ? at[k] : all(-1e9f));
    }
  }
  // To the first place of each block.
  const auto reduce = [&](auto &values, auto better) {
    for (auto &row : values)
      for (std::size_t s = tile_blocks; s < count; s += tile_blocks)
        for (std::size_t block = 0; block < tile_blocks; ++block)
          row[block] = better(row[block], row[s + block]);
  };
  const auto more = [](float a, float b) { return a > b ? a : b; };
  reduce(slopes, more);
  reduce(sights, more);
  reduce(high, more);
  reduce(low, [](float a, float b) { return a < b ? a : b; });
  Shaft tile = no_shaft();
  for (std::size_t block = 0; block < tile_blocks; ++block) {
    Shaft &shaft = of_blocks[block];
    for (std::size_t k = 0; k < directions; ++k) {
      shaft.slopes[k] = slopes[k][block];
      shaft.sights[k] = sights[k][block];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      shaft.low[k] = low[k][block];
      shaft.high[k] = high[k][block];
    }
    shaft.any = shaft.low[2] <= shaft.high[2];
    shaft.in_front = !shaft.any || shaft.high[2] < board.nearest;
    add_shaft(shaft, tile);
  }
  return tile;
}

inline Ways ways_of(const Shaft &shaft, const SilhouetteBoard &board) {
  Ways ways;
  for (int i = 0; i < 8; ++i) {
    const float k = shaft.in_front ? shaft.slopes[i] + slack_m : 0.0f;
    const float low = k * board.diodes_low, high = k * board.diodes_high;
    const float at_diodes = board.supports[i] + (low > high ? low : high), at_lens = k * board.lens_z;
    ways.slopes[i] = k;
    ways.supports[i] = shaft.in_front ? (at_diodes > at_lens ? at_diodes : at_lens) + slack_m : 1e30f;
  }
  for (int i = 0; i < 3; ++i) {
    const float slack = 1e-6f * (std::abs(shaft.low[i]) + std::abs(shaft.high[i])) + slack_m;
    ways.low[i] = shaft.low[i] - slack;
    ways.high[i] = shaft.high[i] + slack;
  }
  ways.farthest = shaft.in_front ? shaft.low[2] - slack_m : -1e30f;
  ways.highest = shaft.in_front ? board.highest + slack_m : 1e30f;
  return ways;
}

// Likewise of the ways to the lens alone, heights from there.
inline Ways sights_of(const Shaft &shaft, const SilhouetteBoard &board) {
  Ways ways = ways_of(shaft, board);
  for (int i = 0; i < 8; ++i) {
    const float k = shaft.in_front ? shaft.sights[i] + slack_m : 0.0f;
    ways.slopes[i] = k;
    ways.supports[i] = shaft.in_front ? k * board.lens_z + slack_m : 1e30f;
  }
  ways.highest = shaft.in_front ? board.lens_z : 1e30f;
  return ways;
}

// Items row by row.
struct Rows {
  const std::int32_t *first;
  std::size_t length; // of a row

  const std::int32_t *at(int row, int i) const {
    return first + static_cast<std::size_t>(row) * length + static_cast<std::size_t>(i);
  }
  std::int32_t word(int row, int i) const { return *at(row, i); }
  Floats floats(int row, int i) const { return load<Floats>(at(row, i)); }
  Ints ints(int row, int i) const { return load<Ints>(at(row, i)); }
};

inline Rows rows_of(const ItemBlock &block) { return {&block.rows[0][0], items_per_block}; }

struct Floats3 {
  Floats x, y, z;
};

inline Floats3 three(const Rows &items, int row, int i) {
  return {items.floats(row, i), items.floats(row + 1, i), items.floats(row + 2, i)};
}
inline Floats dot(const Floats3 &a, const Floats3 &b) {
  return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}
inline Floats3 cross(const Floats3 &a, const Floats3 &b) {
  return {multiply_add(a.y, b.z, -(a.z * b.y)), multiply_add(a.z, b.x, -(a.x * b.z)),
          multiply_add(a.x, b.y, -(a.y * b.x))};
}
inline Floats3 minus(const Floats3 &a, const Floats3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

// Which boxes the ways may meet.
inline Ints may_meet(const Ways &ways, const Floats3 &low, const Floats3 &high) {
  const Floats z_low = larger(low.z, all(ways.farthest)), z_high = smaller(high.z, all(ways.highest));
  const Floats along[8] = {low.x,
                           -high.x,
                           low.y,
                           -high.y,
                           diagonal * (low.x + low.y),
                           -diagonal * (high.x + high.y),
                           diagonal * (low.x - high.y),
                           diagonal * (low.y - high.x)};
  Floats outside = all(-1e30f);
  for (int k = 0; k < 8; ++k) {
    const Floats up = all(ways.slopes[k]);
    outside = larger(outside, along[k] + smaller(up * z_low, up * z_high) - ways.supports[k]);
  }
  return (outside < 0.0f) & (high.z > ways.farthest) & (low.z < ways.highest);
}

inline std::uint32_t meet(const Ways &ways, const BoxBlock &boxes) {
  std::uint32_t met = 0;
  const auto three_at = [](const float(&of)[3][items_per_block], int i) {
    return Floats3{load<Floats>(of[0] + i), load<Floats>(of[1] + i), load<Floats>(of[2] + i)};
  };
  for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
    met |= bits_of(may_meet(ways, three_at(boxes.low, i), three_at(boxes.high, i))) << i;
  return met;
}

// The same of edges or triangles, by their corners.
template <std::size_t corners>
Ints may_meet(const Ways &ways, const Floats3 (&of)[corners]) {
  Floats along[corners][8], low = of[0].z, high = of[0].z, outside = all(-1e30f);
  for (std::size_t c = 0; c < corners; ++c) {
    const Floats u = diagonal * (of[c].x + of[c].y), v = diagonal * (of[c].x - of[c].y);
    const Floats directions[8] = {of[c].x, -of[c].x, of[c].y, -of[c].y, u, -u, v, -v};
    for (int k = 0; k < 8; ++k)
      along[c][k] = multiply_add(all(ways.slopes[k]), of[c].z, directions[k]);
    low = smaller(low, of[c].z);
    high = larger(high, of[c].z);
  }
  for (int k = 0; k < 8; ++k) {
    Floats nearest = along[0][k];
    for (std::size_t c = 1; c < corners; ++c)
      nearest = smaller(nearest, along[c][k]);
    outside = larger(outside, nearest - ways.supports[k]);
  }
  return (outside < 0.0f) & (high > ways.farthest) & (low < ways.highest);
}

// Which edges may change what is seen from one of the samples.
inline Ints may_matter(const Ways &ways, const Rows &items, int i) {
  const Floats3 a = three(items, row_ax, i), ends[2] = {a, three(items, row_bx, i)};
  const Ints meets = may_meet(ways, ends);
  // Both triangles show the same side to all samples.
  const Floats3 n1 = three(items, row_cx, i), n2 = three(items, row_dx, i);
  const Floats3 from{a.x - 0.5f * (ways.low[0] + ways.high[0]), a.y - 0.5f * (ways.low[1] + ways.high[1]),
                     a.z - 0.5f * (ways.low[2] + ways.high[2])};
  const float half[3] = {0.5f * (ways.high[0] - ways.low[0]), 0.5f * (ways.high[1] - ways.low[1]),
                         0.5f * (ways.high[2] - ways.low[2])};
  const Floats h1 = dot(n1, from), h2 = dot(n2, from);
  const Floats r1 = absolute(n1.x) * half[0] + absolute(n1.y) * half[1] + absolute(n1.z) * half[2];
  const Floats r2 = absolute(n2.x) * half[0] + absolute(n2.y) * half[1] + absolute(n2.z) * half[2];
  const Ints no_silhouette = ((h1 > r1) & (h2 > r2)) | ((h1 < -r1) & (h2 < -r2));
  return meets & ~no_silhouette;
}

// Which hidden triangles may lie between the lens and a sample, which is in front of them.
inline Ints may_hide(const Ways &sights, const Rows &items, int i) {
  const Floats3 a = three(items, row_ax, i),
                corners[3] = {a, three(items, row_bx, i), three(items, row_cx, i)};
  const Floats3 normal = cross(minus(corners[1], a), minus(corners[2], a));
  const Floats3 from{0.5f * (sights.low[0] + sights.high[0]) - a.x,
                     0.5f * (sights.low[1] + sights.high[1]) - a.y,
                     0.5f * (sights.low[2] + sights.high[2]) - a.z};
  const Floats reach =
      absolute(normal.x) * (0.5f * (sights.high[0] - sights.low[0]) + 1e-6f * absolute(a.x) + slack_m) +
      absolute(normal.y) * (0.5f * (sights.high[1] - sights.low[1]) + 1e-6f * absolute(a.y) + slack_m) +
      absolute(normal.z) * (0.5f * (sights.high[2] - sights.low[2]) + 1e-6f * absolute(a.z) + slack_m);
  return (dot(normal, from) + reach > 0.0f) & may_meet(sights, corners);
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
