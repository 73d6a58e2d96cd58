#pragma once
// The sweep itself: which diodes each edge takes from a sample (docs/theory.md, "Angles, ranks and lines").

#include "engine/shadow/host/exact_decisions.h"
#include "engine/shadow/host/item_lists.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Edges' parts of the diodes' angles about the board's centre, for one sample. Diodes in the angle are beyond
// the edge where line . L + offset < 0.
struct Pairs {
  alignas(64) float line_x[segment + lanes], line_y[segment + lanes], offset[segment + lanes],
      near_line[segment + lanes];
  alignas(64) float end_x[2][segment + lanes], end_y[2][segment + lanes]; // whose angles the ends have
  alignas(64) std::int32_t item[segment + lanes];
  alignas(64) std::int32_t from[segment + lanes], to[segment + lanes], wraps[segment + lanes]; // ranks
  alignas(64) std::int32_t turned[segment + lanes]; // the edge runs clockwise as seen from the sample
  alignas(64) std::int32_t amount[segment + lanes]; // what it adds to the counts, unless that is unsure
  alignas(64) std::int32_t is_unsure[segment + lanes];
  int count;
};

// A sample on its way, and what is found of it.
struct Sweep {
  float depth, reach, beside, tolerance;
  float to_lens[3];
  bool is_unclear, is_touched;
  int base;                                    // surfaces before the board's centre
  alignas(64) std::int32_t counts[diode_room]; // surfaces before each diode, in the order of angles
};

inline void begin_sweep(const Sample &sample, const SilhouetteBoard &board, Sweep &sweep) {
  const float *p = sample.point;
  sweep.depth = -p[2];
  // Where edges matter about the centre: as far as diodes stand, and the lens, projected on the board.
  sweep.reach = 1.0005f * board.radius;
  const float aside = std::sqrt(p[0] * p[0] + p[1] * p[1]);
  if (board.lens_apart) {
    const float projected = 1.0005f * aside * std::abs(board.lens_z / (board.lens_z + sweep.depth));
    sweep.reach = projected > sweep.reach ? projected : sweep.reach;
  }
  sweep.beside = 2e-5f * (std::abs(p[0]) + std::abs(p[1]) + board.radius) + 1e-6f;
  sweep.tolerance = 5e-7f * (std::abs(p[0]) + std::abs(p[1]) + sweep.depth + board.radius);
  sweep.to_lens[0] = -p[0], sweep.to_lens[1] = -p[1], sweep.to_lens[2] = board.lens_z + sweep.depth;
  sweep.is_unclear = board.exact_only || !(p[2] < board.nearest);
  sweep.is_touched = false;
  sweep.base = 0;
}

// Clears the counts before the first edge counts something.
inline void touch(Sweep &sweep) {
  if (!sweep.is_touched)
    std::memset(sweep.counts, 0, sizeof(sweep.counts));
  sweep.is_touched = true;
}

// An angle's measure that grows with it, 0 to 4.
inline Floats turn_of(const Floats &x, const Floats &y) {
  const Floats t = y * inverse(larger(absolute(x) + absolute(y), all(1e-30f)));
  return x < 0.0f ? 2.0f - t : y < 0.0f ? 4.0f + t : t;
}

// The number of diodes of smaller angles. Any angle has one, and that of an end is the same for all edges
// that meet there: so it does not matter how it is rounded.
inline Ints rank_of(const Floats &turn, const SilhouetteBoard &board) {
  const Ints fine = __builtin_convertvector(turn * static_cast<float>(1 << fine_turn_bits), Ints);
  const Ints within = smaller(larger(fine, Ints{}), all((4 << fine_turn_bits) - 1));
  const Ints ranks = gathered(board.bin_ranks, within >> bin_bits);
  Ints beyond = (within & bin_mask) > ((ranks >> threshold_shift) & bin_mask);
  Ints rank = (beyond ? ranks >> rank_bits : ranks) & rank_mask;
  beyond &= (ranks & more_classes) != 0;
  while (bits_of(beyond) != 0) {
    beyond &= turn > gathered(board.rank_turn, rank);
    rank = beyond ? gathered(board.next_rank, rank) : rank;
  }
  return rank;
}

// Edges as one sample sees them, a lane an edge.
struct Crossings {
  Ints counted; // it has to be looked at
  Ints weight, is_unsure;
  Floats line_x, line_y, offset, near_line;
};

// The sides of its triangles that an edge shows.
inline void find_weights(const Rows &items, int i, const Floats3 &a, const Floats &size_a, Crossings &found) {
  const Ints sides = items.ints(row_sides, i);
  const Ints is_boundary = items.ints(row_second, i) == static_cast<std::int32_t>(shader::item_boundary);
  const Floats h1 = dot(three(items, row_cx, i), a), h2 = dot(three(items, row_dx, i), a);
  const Floats unsure_height = 6e-7f * size_a;
  found.is_unsure = (absolute(h1) < unsure_height) | (~is_boundary & (absolute(h2) < unsure_height));
  const Ints one = all(1), none{};
  const auto weight = [&](const Floats &height, const Ints &side) {
    return height < 0.0f ? (side == 1 ? none : one) : (side == 2 ? none : -one);
  };
  const Ints w1 = weight(h1, sides & 3), w2 = weight(h2, (sides >> 2) & 3);
  found.weight = is_boundary ? -w1 : w2 - w1;
}

// Counts the edges that the light's way from the lens to the board's centre crosses.
inline void count_base(const Rows &items, int i, const Crossings &found, const Floats3 &clipped_a,
                       const Floats3 &clipped_b, const Floats3 &line, const Sample &sample,
                       const SilhouetteBoard &board, Sweep &sweep) {
  const float *p = sample.point, *l = sweep.to_lens, depth = sweep.depth;
  // The plane of sample, lens and centre.
  const float plane_x = l[1] * depth + l[2] * p[1], plane_y = -l[2] * p[0] - l[0] * depth,
              plane_z = l[1] * p[0] - l[0] * p[1];
  const Floats side_a = plane_x * clipped_a.x + plane_y * clipped_a.y + plane_z * clipped_a.z,
               side_b = plane_x * clipped_b.x + plane_y * clipped_b.y + plane_z * clipped_b.z;
  const Floats at_lens = line.x * l[0] + line.y * l[1] + line.z * l[2];
  const Ints splits = found.counted & ((side_a > 0.0f) ^ (side_b > 0.0f));
  const Ints crosses = splits & ((at_lens > 0.0f) ^ (found.offset > 0.0f));
  const Ints close = (absolute(at_lens) < found.near_line) | (absolute(found.offset) < found.near_line);
  if (bits_of(splits & close) != 0)
    sweep.is_unclear = true;
  for (std::uint32_t bits = bits_of(crosses); bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    const int weight = found.is_unsure[k] ? exact_weight(items, i + k, sample, board) : found.weight[k];
    sweep.base += at_lens[k] > 0.0f ? -weight : weight;
  }
}

inline void add_pairs(const Crossings &found, int i, const Floats (&end_x)[2], const Floats (&end_y)[2],
                      Pairs &pairs) {
  const Packing packed(bits_of(found.counted));
  const int at = pairs.count;
  store(pairs.line_x + at, packed(found.line_x));
  store(pairs.line_y + at, packed(found.line_y));
  store(pairs.offset + at, packed(found.offset));
  store(pairs.near_line + at, packed(found.near_line));
  for (int end = 0; end < 2; ++end) {
    store(pairs.end_x[end] + at, packed(end_x[end]));
    store(pairs.end_y[end] + at, packed(end_y[end]));
  }
  store(pairs.item + at, packed(lane_numbers() + i));
  store(pairs.amount + at, packed(-found.weight));
  store(pairs.is_unsure + at, packed(found.is_unsure));
  pairs.count += packed.count();
}

// Finds the edges among a vector's that may take diodes from a sample.
inline void find_crossings(const Rows &items, int i, int count, const Sample &sample,
                           const SilhouetteBoard &board, Sweep &sweep, Pairs &pairs) {
  const float *p = sample.point, *rest = sample.rest, depth = sweep.depth, reach = sweep.reach;
  const Floats3 a{(items.floats(row_ax, i) - p[0]) + (items.floats(row_rest_ax, i) - rest[0]),
                  (items.floats(row_ay, i) - p[1]) + (items.floats(row_rest_ay, i) - rest[1]),
                  (items.floats(row_az, i) - p[2]) + (items.floats(row_rest_az, i) - rest[2])};
  const Floats3 b{(items.floats(row_bx, i) - p[0]) + (items.floats(row_rest_bx, i) - rest[0]),
                  (items.floats(row_by, i) - p[1]) + (items.floats(row_rest_by, i) - rest[1]),
                  (items.floats(row_bz, i) - p[2]) + (items.floats(row_rest_bz, i) - rest[2])};
  Crossings found;
  const Floats size_a = absolute(a.x) + absolute(a.y) + absolute(a.z);
  find_weights(items, i, a, size_a, found);
  const Ints own = all(static_cast<std::int32_t>(sample.own));
  const Floats highest = larger(a.z, b.z);
  found.counted = (lane_numbers() < count - i) & (items.ints(row_first, i) != own) &
                  (items.ints(row_second, i) != own) & (highest > 0.0f) & (smaller(a.z, b.z) < depth) &
                  ((found.weight != 0) | found.is_unsure);
  // The ends, as far as the edge lies between the depths of sample and board, projected on the board.
  const Floats3 way = minus(b, a);
  const Floats per_height = inverse(absolute(way.z) < 1e-30f ? all(1e-30f) : way.z);
  const Floats low_x = a.x - a.z * per_height * way.x, low_y = a.y - a.z * per_height * way.y;
  const Floats up = (depth - a.z) * per_height, high_x = a.x + up * way.x, high_y = a.y + up * way.y;
  const auto clipped = [&](const Floats3 &end) {
    const Ints below = end.z<0.0f, above = end.z> depth;
    return Floats3{below   ? low_x
                   : above ? high_x
                           : end.x,
                   below   ? low_y
                   : above ? high_y
                           : end.y,
                   below   ? Floats{}
                   : above ? all(depth)
                           : end.z};
  };
  const Floats3 clipped_a = clipped(a), clipped_b = clipped(b);
  const Floats qa_x = p[0] * clipped_a.z + clipped_a.x * depth,
               qa_y = p[1] * clipped_a.z + clipped_a.y * depth,
               qb_x = p[0] * clipped_b.z + clipped_b.x * depth,
               qb_y = p[1] * clipped_b.z + clipped_b.y * depth;
  const Floats size_qa = absolute(qa_x) + absolute(qa_y), size_qb = absolute(qb_x) + absolute(qb_y);
  // The edge's line on the board: line . L + offset, negative beyond it as seen from a counter-clockwise
  // edge.
  const Floats3 line = cross(a, way);
  found.line_x = line.x, found.line_y = line.y;
  found.offset = line.z * depth - (line.x * p[0] + line.y * p[1]);
  found.near_line = sweep.tolerance * size_a * (absolute(way.x) + absolute(way.y) + absolute(way.z));
  // Its least distance from the centre is at most that of the diodes: of the ends where one is nearest, else
  // of the line.
  const Floats along_x = qb_x * clipped_a.z - qa_x * clipped_b.z,
               along_y = qb_y * clipped_a.z - qa_y * clipped_b.z;
  const Ints past_a = (qa_x * along_x + qa_y * along_y > 0.0f) & (clipped_a.z > 0.0f),
             past_b = (qb_x * along_x + qb_y * along_y < 0.0f) & (clipped_b.z > 0.0f);
  const Ints near_a = size_qa <= 1.5f * reach * clipped_a.z, near_b = size_qb <= 1.5f * reach * clipped_b.z;
  const Floats square = line.x * line.x + line.y * line.y;
  const Ints line_is_near =
      found.offset * found.offset <= reach * reach * square * 1.001f + found.near_line * found.near_line;
  found.counted = found.counted & line_is_near & (~past_a | near_a) & (~past_b | near_b);
  if (bits_of(found.counted) == 0)
    return;
  // An end before the centre has no angle, nor one beside the sample at its own height.
  const auto at_centre = [&](const Floats3 &end, const Floats3 &clipped_end, const Floats &size) {
    const Floats low = end.z < 0.0f ? all(sweep.beside * depth) : Floats{};
    return size <= larger(5e-6f * clipped_end.z, low);
  };
  Ints unclear = at_centre(a, clipped_a, size_qa) | at_centre(b, clipped_b, size_qb);
  if (board.lens_apart)
    unclear |= highest > board.nearest + depth;
  sweep.is_unclear = sweep.is_unclear || bits_of(found.counted & unclear) != 0;
  if (board.lens_apart)
    count_base(items, i, found, clipped_a, clipped_b, line, sample, board, sweep);
  add_pairs(found, i, {qa_x, qb_x}, {qa_y, qb_y}, pairs);
}

// Finds the ranks between the ends of a vector's pairs, and turns those that run clockwise.
inline void find_ranks(Pairs &pairs, int i, const SilhouetteBoard &board, Sweep &sweep) {
  const Floats turn_a = turn_of(load<Floats>(pairs.end_x[0] + i), load<Floats>(pairs.end_y[0] + i)),
               turn_b = turn_of(load<Floats>(pairs.end_x[1] + i), load<Floats>(pairs.end_y[1] + i));
  Floats turn = turn_b - turn_a;
  turn = turn > 2.0f ? turn - 4.0f : turn < -2.0f ? turn + 4.0f : turn;
  const Floats offset = load<Floats>(pairs.offset + i);
  const Ints is_there = lane_numbers() < pairs.count - i;
  const Ints unclear = (absolute(offset) < load<Floats>(pairs.near_line + i)) & (absolute(turn) > 0.5f);
  sweep.is_unclear = sweep.is_unclear || bits_of(is_there & unclear) != 0;
  const Ints turned = absolute(turn) > 1.9f ? offset < 0.0f : turn < 0.0f;
  const Floats from = turned ? turn_b : turn_a, to = turned ? turn_a : turn_b;
  store(pairs.from + i, rank_of(from, board));
  store(pairs.to + i, rank_of(to, board));
  store(pairs.wraps + i, from > to);
  store(pairs.turned + i, turned);
  const auto turn_back = [&](auto *values) {
    using Vector = std::conditional_t<std::is_same_v<decltype(values), float *>, Floats, Ints>;
    const Vector v = load<Vector>(values + i);
    store(values + i, turned ? -v : v);
  };
  turn_back(pairs.line_x);
  turn_back(pairs.line_y);
  turn_back(pairs.offset);
  turn_back(pairs.amount);
}

// Which of the diodes that are too close to the line for floats lie beyond it.
inline Mask decide_close(const Pairs &pairs, int pair, std::uint32_t first, std::uint32_t bits,
                         Mask lanes_beyond, const Rows &items, const Sample &sample,
                         const SilhouetteBoard &board) {
  std::uint32_t beyond = bits_of(lanes_beyond) & ~bits;
  const Exact3 a = exact_place(items, row_ax, row_rest_ax, pairs.item[pair], sample),
               b = exact_place(items, row_bx, row_rest_bx, pairs.item[pair], sample), edge = cross(a, b);
  for (; bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    const std::uint32_t d = first + static_cast<std::uint32_t>(k);
    const Exact3 diode{board.exact_m[0][d] - sample.exact[0], board.exact_m[1][d] - sample.exact[1],
                       board.exact_m[2][d] - sample.exact[2]};
    const double volume = dot(edge, diode);
    if (pairs.turned[pair] != 0 ? volume > 0.0 : volume < 0.0)
      beyond |= 1u << k;
  }
  return mask_of(beyond);
}

// Adds to the counts of the diodes of a pair's angle that lie beyond its line.
inline void count_pair(const Pairs &pairs, int pair, int amount, const Rows &items, const Sample &sample,
                       const SilhouetteBoard &board, std::int32_t *counts) {
  const Floats line_x = all(pairs.line_x[pair]), line_y = all(pairs.line_y[pair]),
               offset = all(pairs.offset[pair]), near_line = all(pairs.near_line[pair]);
  const Ints amounts = all(amount), numbers = lane_numbers();
  const auto count_lanes = [&](std::int32_t d, Mask in_angle) {
    const auto at = static_cast<std::uint32_t>(d);
    const Floats f = multiply_add(line_x, load<Floats>(board.x_m + at),
                                  multiply_add(line_y, load<Floats>(board.y_m + at), offset));
    Mask beyond = less(f, Floats{}) & in_angle;
    if (const std::uint32_t close = bits_of(less(absolute(f), near_line) & in_angle); close != 0) [[unlikely]]
      beyond = decide_close(pairs, pair, at, close, beyond, items, sample, board);
    store(counts + at, add_where(beyond, load<Ints>(counts + at), amounts));
  };
  // Counts diodes of ranks from `first` up to `end`. Most pairs end within two vectors; in which, none can
  // foretell.
  const auto count = [&](std::int32_t first, std::int32_t end) {
    std::int32_t d = first & ~(lanes - 1);
    count_lanes(d, without(less(numbers, all(end - d)), less(numbers, all(first - d))));
    d += lanes;
    do {
      count_lanes(d, less(numbers, all(end - d)));
      d += lanes;
    } while (d < end);
  };
  const std::int32_t from = pairs.from[pair], to = pairs.to[pair];
  count(from, pairs.wraps[pair] != 0 ? static_cast<std::int32_t>(board.diodes) : to);
  if (pairs.wraps[pair] != 0)
    count(0, to);
}

inline void sweep_over(const ItemList &list, const Sample &sample, const SilhouetteBoard &board, Pairs &pairs,
                       Sweep &sweep) {
  const Rows items = list.all();
  pairs.count = 0;
  for (int i = 0; i < list.count; i += lanes)
    find_crossings(items, i, list.count, sample, board, sweep, pairs);
  if (pairs.count == 0)
    return;
  for (int i = 0; i < pairs.count; i += lanes)
    find_ranks(pairs, i, board, sweep);
  touch(sweep);
  for (int pair = 0; pair < pairs.count; ++pair) {
    const std::int32_t around = pairs.wraps[pair] != 0 ? static_cast<std::int32_t>(board.diodes) : 0;
    if (pairs.to[pair] + around <= pairs.from[pair])
      continue; // no diode is in its angle
    int amount = pairs.amount[pair];
    if (pairs.is_unsure[pair] != 0) {
      const int weight = exact_weight(items, pairs.item[pair], sample, board);
      amount = pairs.turned[pair] != 0 ? weight : -weight;
    }
    if (amount != 0)
      count_pair(pairs, pair, amount, items, sample, board, sweep.counts);
  }
}

// Finds the diodes in front of a sample's surface, behind which others may stand; a word each.
inline void find_facing(const Sample &sample, const SilhouetteBoard &board, std::int32_t *faces) {
  const float *n = sample.normal,
              offset = n[0] * sample.point[0] + n[1] * sample.point[1] + n[2] * sample.point[2];
  for (std::uint32_t d = 0; d < board.diodes; d += lanes) {
    Floats height;
    for (int i = 0; i < lanes; ++i)
      height[i] = n[2] * static_cast<float>(board.exact_m[2][d + static_cast<std::uint32_t>(i)]);
    height += n[0] * load<Floats>(board.x_m + d) + n[1] * load<Floats>(board.y_m + d) - offset;
    store(faces + d, height > 0.0f);
  }
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
