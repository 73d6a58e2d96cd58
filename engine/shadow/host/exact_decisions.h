#pragma once
// Decisions that floats cannot make, in double.

#include "engine/shadow/host/ways.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

struct Exact3 {
  double x, y, z;
};
inline Exact3 minus(const Exact3 &a, const Exact3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Exact3 cross(const Exact3 &a, const Exact3 &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(const Exact3 &a, const Exact3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// An item's place, from the sample.
inline Exact3 exact_place(const Rows &items, int row, int rest_row, int i, const Sample &sample) {
  const auto at = [&](int k) {
    const auto value = [&](int of) {
      float v;
      const std::int32_t word = items.word(of + k, i);
      std::memcpy(&v, &word, sizeof(v));
      return static_cast<double>(v);
    };
    return value(row) + value(rest_row) - sample.exact[k];
  };
  return {at(0), at(1), at(2)};
}

constexpr double own_rounding = 2.3e-13; // as in sweep_weight.glsl

// -1, 0 or 1: on which side of a plane the sample lies, if its own rounding leaves a side.
inline int exact_side(const double (&plane)[4], const Sample &sample, const SilhouetteBoard &board) {
  const double *p = sample.exact;
  const double rounding =
      own_rounding * (std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) + std::abs(plane[3])) +
      board.world_rounding_m;
  const double height = plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] - plane[3];
  return std::abs(height) <= rounding ? 0 : height > 0.0 ? 1 : -1;
}

// A triangle's part in its edges' weights: its side as seen from the sample, but nothing where board and
// sample are on one side, so that it can never be between.
inline int weight_of(int side, std::uint32_t board_side) {
  return (side > 0 && board_side == 1) || (side < 0 && board_side == 2) ? 0 : side;
}

inline int exact_weight(const Rows &items, int i, const Sample &sample, const SilhouetteBoard &board) {
  const auto at = [&](int row) { return static_cast<std::uint32_t>(items.word(row, i)); };
  const EdgePlanes &planes = board.planes[at(row_number)];
  const std::uint32_t sides = at(row_sides);
  const int first = weight_of(exact_side(planes.first, sample, board), sides & 3u);
  if (at(row_second) == shader::item_boundary)
    return -first;
  return weight_of(exact_side(planes.second, sample, board), sides >> 2 & 3u) - first;
}

// Which hidden triangles may lie between a sample and the lens, by floats.
inline Ints may_hide_from(const Sample &sample, const float (&lens)[3], const Rows &items, int i) {
  const auto from = [&](int row) {
    return Floats3{items.floats(row, i) - sample.point[0], items.floats(row + 1, i) - sample.point[1],
                   items.floats(row + 2, i) - sample.point[2]};
  };
  const Floats3 a = from(row_ax), b = from(row_bx), c = from(row_cx),
                to_lens{all(lens[0]), all(lens[1]), all(lens[2])};
  const Floats ab = dot(cross(a, b), to_lens), bc = dot(cross(b, c), to_lens), ca = dot(cross(c, a), to_lens);
  const auto size = [](const Floats3 &v) { return absolute(v.x) + absolute(v.y) + absolute(v.z); };
  const Floats size_a = size(a), size_b = size(b), size_c = size(c);
  const Floats slack =
      1e-6f * sum_of_sizes(lens) * larger(size_a * size_b, larger(size_b * size_c, size_c * size_a));
  const Ints inside =
      ((ab > -slack) & (bc > -slack) & (ca > -slack)) | ((ab < slack) & (bc < slack) & (ca < slack));
  const Floats3 normal = cross(minus(b, a), minus(c, a));
  const Floats rounding =
      1e-6f * (absolute(normal.x * a.x) + absolute(normal.y * a.y) + absolute(normal.z * a.z));
  return inside & (dot(normal, a) < rounding);
}

inline bool hides(const Rows &items, int i, const Sample &sample, const Exact3 &lens) {
  const Exact3 a = exact_place(items, row_ax, row_rest_ax, i, sample),
               b = exact_place(items, row_bx, row_rest_bx, i, sample),
               c = exact_place(items, row_cx, row_dx, i, sample);
  const bool ab = dot(cross(a, b), lens) > 0.0, bc = dot(cross(b, c), lens) > 0.0,
             ca = dot(cross(c, a), lens) > 0.0;
  const Exact3 normal = cross(minus(b, a), minus(c, a));
  // The sample in front of it, the lens behind.
  return ab == bc && bc == ca && dot(normal, a) < 0.0 && dot(normal, minus(lens, a)) < 0.0;
}

// The hidden triangles between the sample and the lens.
inline int count_hidden(const ItemTree &tree, const ListedBlock *listed, std::uint32_t count,
                        const Sample &sample, const SilhouetteBoard &board) {
  const float to_lens[3] = {-sample.point[0], -sample.point[1], board.lens_z - sample.point[2]};
  const Exact3 lens{-sample.exact[0], -sample.exact[1], static_cast<double>(board.lens_z) - sample.exact[2]};
  int hidden = 0;
  for (std::uint32_t entry = 0; entry < count; ++entry) {
    const Rows items = rows_of(tree.items[listed[entry].block]);
    for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
      for (std::uint32_t bits = bits_of(may_hide_from(sample, to_lens, items, i)) & listed[entry].bits >> i;
           bits != 0; bits &= bits - 1)
        hidden += hides(items, i + std::countr_zero(bits), sample, lens) ? 1 : 0;
  }
  return hidden;
}

// Counts an edge where it crosses the triangle of sample, lens and diode, for all diodes. All places from the
// sample.
inline void cross_triangles(const Exact3 &a, const Exact3 &b, const Exact3 &lens, int weight,
                            const Sample &sample, const SilhouetteBoard &board, std::int32_t *counts) {
  const Exact3 edge = cross(a, b), of_a = cross(a, lens), of_b = cross(b, lens),
               past_lens = cross(minus(a, lens), minus(b, lens));
  const bool lens_side = dot(edge, lens) > 0.0;
  const int change = lens_side ? -weight : weight;
  for (std::uint32_t d = 0; d < board.diodes; d += double_lanes) {
    const Doubles x = load<Doubles>(board.exact_m[0] + d) - sample.exact[0],
                  y = load<Doubles>(board.exact_m[1] + d) - sample.exact[1],
                  z = load<Doubles>(board.exact_m[2] + d) - sample.exact[2];
    const Longs start = of_a.x * x + of_a.y * y + of_a.z * z > 0.0,
                end = of_b.x * x + of_b.y * y + of_b.z * z > 0.0;
    const Longs at_diode = edge.x * x + edge.y * y + edge.z * z > 0.0;
    const Longs far =
        past_lens.x * (x - lens.x) + past_lens.y * (y - lens.y) + past_lens.z * (z - lens.z) > 0.0;
    const Longs at_lens = Longs{} - (lens_side ? 1 : 0);
    const Longs crosses = (start ^ end) & (at_lens ^ at_diode) & ~(at_lens ^ far);
    for (int i = 0; i < double_lanes; ++i)
      counts[d + static_cast<std::uint32_t>(i)] += crosses[i] != 0 ? change : 0;
  }
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
