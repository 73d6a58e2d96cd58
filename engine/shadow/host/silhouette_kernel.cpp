// The loops of the host's sweep. Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET its name; see
// engine/CMakeLists.txt. They do what the shaders of the sweep do, a lane an edge in place of a sample.
#include "engine/shadow/host/lanes.h"
#include "engine/shadow/host/silhouettes.h"

#include <bit>
#include <cmath>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr float diagonal = 0.70710678f;
constexpr float slack_m = 1e-5f; // rounding of what lies on a shaft's side
constexpr int segment = 512;     // items at a time
constexpr int block_wide = 4, block_high = 2, block_samples = block_wide * block_high;
constexpr int tile_side = shader::tile_side;

struct Sample {
  bool sees;
  std::uint32_t own;
  double exact[3];
  float point[3], rest[3], normal[3];
};

inline float sum_of_sizes(const float (&v)[3]) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

// ---- Samples

double real_at(const std::byte *from, bool has_fp64) {
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
void find_ray(const SampleSource &of, double column, double row, double (&ray)[2]) {
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
void find_point(const SampleSource &of, const Place &at, double (&point)[3], std::uint32_t &shape) {
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

void find_sample(const SilhouetteBoard &board, const SampleSource &of, const Place &at, Sample &sample) {
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
bool find_samples(const SilhouetteBoard &board, const SampleSource &of, std::uint32_t tile, Sample *samples,
                  TileBits &bits) {
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
    samples[i].sees = false;
    if (!bits.is_there[i])
      continue;
    at.index = subsample * strip.padded_pixels + at.row * strip.columns + at.column;
    bits.index[i] = at.index;
    find_sample(board, of, at, samples[i]);
    any = any || samples[i].sees;
  }
  return any;
}

// ---- What may lie between some samples and the board

// The supports of a point along the eight directions.
void along_directions(const float *p, float (&along)[8]) {
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

// What a set of samples keeps within.
struct Shaft {
  float slopes[8], sights[8]; // of the ways to the board, and to the lens
  float low[3], high[3];
  bool in_front, turns_away, any;
};

bool may_turn_away(const Sample &sample, const SilhouetteBoard &board) {
  const float *n = sample.normal, *p = sample.point;
  const float across = std::sqrt(n[0] * n[0] + n[1] * n[1]);
  const float up = n[2] * (n[2] > 0.0f ? board.diodes_low : board.diodes_high);
  const float lowest = up - (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) - 1.00001f * board.radius * across;
  return lowest < 1e-6f * (sum_of_sizes(sample.point) + board.radius);
}

Shaft no_shaft() {
  Shaft shaft{};
  for (int i = 0; i < 8; ++i)
    shaft.slopes[i] = shaft.sights[i] = -1e9f;
  for (int i = 0; i < 3; ++i)
    shaft.low[i] = 1e9f, shaft.high[i] = -1e9f;
  shaft.in_front = true;
  return shaft;
}

void add_sample(const Sample &sample, const SilhouetteBoard &board, Shaft &shaft) {
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

Ways ways_of(const Shaft &shaft, const SilhouetteBoard &board) {
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
Ways sights_of(const Shaft &shaft, const SilhouetteBoard &board) {
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

Rows rows_of(const ItemBlock &block) { return {&block.rows[0][0], items_per_block}; }

struct Floats3 {
  Floats x, y, z;
};

inline Floats3 three(const Rows &items, int row, int i) {
  return {items.floats(row, i), items.floats(row + 1, i), items.floats(row + 2, i)};
}
inline Floats dot(const Floats3 &a, const Floats3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Floats3 cross(const Floats3 &a, const Floats3 &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Floats3 minus(const Floats3 &a, const Floats3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

// Which boxes the ways may meet.
Ints may_meet(const Ways &ways, const Floats3 &low, const Floats3 &high) {
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

std::uint32_t meet(const Ways &ways, const BoxBlock &boxes) {
  std::uint32_t met = 0;
  const auto three_at = [](const float(&of)[3][items_per_block], int i) {
    return Floats3{load<Floats>(of[0] + i), load<Floats>(of[1] + i), load<Floats>(of[2] + i)};
  };
  for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
    met |= bits_of(may_meet(ways, three_at(boxes.low, i), three_at(boxes.high, i))) << i;
  return met;
}

// Which edges may change what is seen from one of the samples.
Ints may_matter(const Ways &ways, const Rows &items, int i) {
  const Floats3 a = three(items, row_ax, i), b = three(items, row_bx, i);
  const Floats ua = diagonal * (a.x + a.y), va = diagonal * (a.x - a.y), ub = diagonal * (b.x + b.y),
               vb = diagonal * (b.x - b.y);
  const Floats along_a[8] = {a.x, -a.x, a.y, -a.y, ua, -ua, va, -va},
               along_b[8] = {b.x, -b.x, b.y, -b.y, ub, -ub, vb, -vb};
  Floats outside = all(-1e30f);
  for (int k = 0; k < 8; ++k) {
    const Floats up = all(ways.slopes[k]);
    outside = larger(outside, smaller(along_a[k] + up * a.z, along_b[k] + up * b.z) - ways.supports[k]);
  }
  const Ints meets =
      (outside < 0.0f) & (larger(a.z, b.z) > ways.farthest) & (smaller(a.z, b.z) < ways.highest);
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

// A corner of the box around a triangle.
template <class Choose>
Floats3 corner(const Floats3 &a, const Floats3 &b, const Floats3 &c, Choose choose) {
  return {choose(choose(a.x, b.x), c.x), choose(choose(a.y, b.y), c.y), choose(choose(a.z, b.z), c.z)};
}

// Which hidden triangles may lie between the lens and a sample, which is in front of them.
Ints may_hide(const Ways &sights, const Rows &items, int i) {
  const Floats3 a = three(items, row_ax, i), b = three(items, row_bx, i), c = three(items, row_cx, i);
  const Floats3 normal = cross(minus(b, a), minus(c, a));
  const Floats3 from{0.5f * (sights.low[0] + sights.high[0]) - a.x,
                     0.5f * (sights.low[1] + sights.high[1]) - a.y,
                     0.5f * (sights.low[2] + sights.high[2]) - a.z};
  const Floats reach =
      absolute(normal.x) * (0.5f * (sights.high[0] - sights.low[0]) + 1e-6f * absolute(a.x) + slack_m) +
      absolute(normal.y) * (0.5f * (sights.high[1] - sights.low[1]) + 1e-6f * absolute(a.y) + slack_m) +
      absolute(normal.z) * (0.5f * (sights.high[2] - sights.low[2]) + 1e-6f * absolute(a.z) + slack_m);
  return (dot(normal, from) + reach > 0.0f) &
         may_meet(sights, corner(a, b, c, smaller<Floats>), corner(a, b, c, larger<Floats>));
}

// Lists the items that matter, block by block; returns how many blocks there are.
template <class Matters>
std::uint32_t list_items(const ItemTree &tree, const Ways &ways, Matters matters, ListedBlock *listed) {
  if (tree.blocks == 0)
    return 0;
  struct Step {
    std::uint32_t level, block;
  } stack[most_box_levels * items_per_block + 1];
  int depth = 0;
  std::uint32_t found = 0;
  stack[depth++] = {tree.levels - 1, 0};
  while (depth > 0) {
    const Step step = stack[--depth];
    std::uint32_t met = meet(ways, tree.boxes[step.level][step.block]);
    for (; met != 0; met &= met - 1) {
      const std::uint32_t below =
          step.block * items_per_block + static_cast<std::uint32_t>(std::countr_zero(met));
      if (step.level > 0) {
        stack[depth++] = {step.level - 1, below};
        continue;
      }
      std::uint32_t bits = 0;
      const Rows items = rows_of(tree.items[below]);
      for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
        bits |= bits_of(matters(ways, items, i)) << i;
      listed[found] = {below, bits};
      found += bits != 0 ? 1 : 0;
    }
  }
  return found;
}

// Some items, beside each other.
struct ItemList {
  alignas(64) std::int32_t rows[item_rows][segment + lanes];
  int count;

  Rows all() const { return {&rows[0][0], segment + lanes}; }

  void add(const Rows &from, int i, std::uint32_t bits) {
    if (bits == 0)
      return;
    const Packing packed(bits);
    for (int row = 0; row < static_cast<int>(item_rows); ++row)
      store(rows[row] + count, packed(from.ints(row, i)));
    count += packed.count();
  }
};

// From the listed blocks, as many as fit; returns the first one that did not.
std::uint32_t gather(const ItemTree &tree, const ListedBlock *listed, std::uint32_t first, std::uint32_t end,
                     ItemList &to) {
  to.count = 0;
  for (; first < end && to.count + static_cast<int>(items_per_block) <= segment; ++first)
    for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
      to.add(rows_of(tree.items[listed[first].block]), i,
             listed[first].bits >> i & ((std::uint32_t{1} << lanes) - 1u));
  return first;
}

template <class Matters>
void narrow(const ItemList &from, const Ways &ways, Matters matters, ItemList &to) {
  to.count = 0;
  for (int i = 0; i < from.count; i += lanes) {
    const std::uint32_t there = from.count - i < lanes ? (1u << (from.count - i)) - 1u : ~0u;
    to.add(from.all(), i, bits_of(matters(ways, from.all(), i)) & there);
  }
}

// ---- Exact decisions, in double

struct Exact3 {
  double x, y, z;
};
Exact3 minus(const Exact3 &a, const Exact3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Exact3 cross(const Exact3 &a, const Exact3 &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Exact3 &a, const Exact3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// An item's place, from the sample.
Exact3 exact_place(const Rows &items, int row, int rest_row, int i, const Sample &sample) {
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
int exact_side(const double (&plane)[4], const Sample &sample, const SilhouetteBoard &board) {
  const double *p = sample.exact;
  const double rounding =
      own_rounding * (std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) + std::abs(plane[3])) +
      board.world_rounding_m;
  const double height = plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] - plane[3];
  return std::abs(height) <= rounding ? 0 : height > 0.0 ? 1 : -1;
}

// What a triangle adds to its edges: its side as seen from the sample, but nothing where board and sample are
// on one side, so that it can never be between.
int weight_of(int side, std::uint32_t board_side) {
  return (side > 0 && board_side == 1) || (side < 0 && board_side == 2) ? 0 : side;
}

int exact_weight(const Rows &items, int i, const Sample &sample, const SilhouetteBoard &board) {
  const auto at = [&](int row) { return static_cast<std::uint32_t>(items.word(row, i)); };
  const EdgePlanes &planes = board.planes[at(row_number)];
  const std::uint32_t sides = at(row_sides);
  const int first = weight_of(exact_side(planes.first, sample, board), sides & 3u);
  if (at(row_second) == shader::item_boundary)
    return -first;
  return weight_of(exact_side(planes.second, sample, board), sides >> 2 & 3u) - first;
}

// Which hidden triangles may lie between a sample and the lens, by floats.
Ints may_hide_from(const Sample &sample, const float (&lens)[3], const Rows &items, int i) {
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

bool hides(const Rows &items, int i, const Sample &sample, const Exact3 &lens) {
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
int count_hidden(const ItemTree &tree, const ListedBlock *listed, std::uint32_t count, const Sample &sample,
                 const SilhouetteBoard &board) {
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
void cross_triangles(const Exact3 &a, const Exact3 &b, const Exact3 &lens, int weight, const Sample &sample,
                     const SilhouetteBoard &board, std::int32_t *counts) {
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

// ---- The sweep

// Edges' parts of the diodes' angles about the board's centre, for one sample: of those in the angle, the
// ones with line . L + offset < 0 are beyond the edge.
struct Pairs {
  alignas(64) float line_x[segment + lanes], line_y[segment + lanes], offset[segment + lanes],
      near_line[segment + lanes];
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
  int base;                                     // surfaces before the board's centre
  alignas(64) std::int32_t counts[most_diodes]; // surfaces before each diode, in the order of angles
};

void begin_sweep(const Sample &sample, const SilhouetteBoard &board, Sweep &sweep) {
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

// The first to count something.
void touch(Sweep &sweep) {
  if (!sweep.is_touched)
    std::memset(sweep.counts, 0, sizeof(sweep.counts));
  sweep.is_touched = true;
}

// An angle's measure that grows with it, 0 to 4.
Floats turn_of(const Floats &x, const Floats &y) {
  const Floats t = y / larger(absolute(x) + absolute(y), all(1e-30f));
  return x < 0.0f ? 2.0f - t : y < 0.0f ? 4.0f + t : t;
}

// Diodes of a smaller angle.
Ints rank_of(const Floats &turn, const SilhouetteBoard &board) {
  const Ints last = all(static_cast<std::int32_t>(angle_bins - 1));
  const Ints bin = __builtin_convertvector(turn * (angle_bins / 4.0f), Ints);
  const Ints within = smaller(larger(bin, Ints{}), last);
  Ints of_angle = gathered(board.class_of_bin, within);
  for (;;) {
    const Ints beyond = turn > gathered(board.class_turn, of_angle);
    if (bits_of(beyond) == 0)
      return gathered(board.class_rank, of_angle);
    of_angle -= beyond;
  }
}

// What edges mean to a sample, a lane an edge.
struct Crossings {
  Ints counted; // it has to be looked at
  Ints weight, is_unsure, turned, wraps, from, to;
  Floats line_x, line_y, offset, near_line;
};

// The sides of its triangles that an edge shows.
void find_weights(const Rows &items, int i, const Floats3 &a, const Floats &size_a, Crossings &found) {
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

// The way of the light from the lens to the board's centre.
void count_base(const Rows &items, int i, const Crossings &found, const Floats3 &clipped_a,
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

Crossings find_crossings(const Rows &items, int i, int count, const Sample &sample,
                         const SilhouetteBoard &board, Sweep &sweep) {
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
  const Floats per_height = 1.0f / (absolute(way.z) < 1e-30f ? all(1e-30f) : way.z);
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
    return found;
  // An end before the centre has no angle, nor one beside the sample at its own height.
  const auto at_centre = [&](const Floats3 &end, const Floats3 &clipped_end, const Floats &size) {
    const Floats low = end.z < 0.0f ? all(sweep.beside * depth) : Floats{};
    return size <= larger(5e-6f * clipped_end.z, low);
  };
  const Floats turn_a = turn_of(qa_x, qa_y), turn_b = turn_of(qb_x, qb_y);
  Floats turn = turn_b - turn_a;
  turn = turn > 2.0f ? turn - 4.0f : turn < -2.0f ? turn + 4.0f : turn;
  Ints unclear = at_centre(a, clipped_a, size_qa) | at_centre(b, clipped_b, size_qb) |
                 ((absolute(found.offset) < found.near_line) & (absolute(turn) > 0.5f));
  if (board.lens_apart)
    unclear |= highest > board.nearest + depth;
  sweep.is_unclear = sweep.is_unclear || bits_of(found.counted & unclear) != 0;
  found.turned = absolute(turn) > 1.9f ? found.offset < 0.0f : turn < 0.0f;
  const Floats from = found.turned ? turn_b : turn_a, to = found.turned ? turn_a : turn_b;
  found.from = rank_of(from, board);
  found.to = rank_of(to, board);
  found.wraps = from > to;
  if (board.lens_apart)
    count_base(items, i, found, clipped_a, clipped_b, line, sample, board, sweep);
  const Ints all_diodes = all(static_cast<std::int32_t>(board.diodes));
  found.counted &= found.to - found.from + (found.wraps & all_diodes) > 0;
  return found;
}

void add_pairs(const Crossings &found, int i, Pairs &pairs) {
  const std::uint32_t bits = bits_of(found.counted);
  if (bits == 0)
    return;
  const Packing packed(bits);
  const int at = pairs.count;
  const auto turned = [&](const auto &v) { return found.turned ? -v : v; };
  store(pairs.line_x + at, packed(turned(found.line_x)));
  store(pairs.line_y + at, packed(turned(found.line_y)));
  store(pairs.offset + at, packed(turned(found.offset)));
  store(pairs.near_line + at, packed(found.near_line));
  store(pairs.item + at, packed(lane_numbers() + i));
  store(pairs.from + at, packed(found.from));
  store(pairs.to + at, packed(found.to));
  store(pairs.wraps + at, packed(found.wraps));
  store(pairs.turned + at, packed(found.turned));
  store(pairs.amount + at, packed(-turned(found.weight)));
  store(pairs.is_unsure + at, packed(found.is_unsure));
  pairs.count += packed.count();
}

// Which of the diodes that are too close to the line for floats lie beyond it.
Ints decide_close(const Pairs &pairs, int pair, std::uint32_t first, std::uint32_t bits, Ints beyond,
                  const Rows &items, const Sample &sample, const SilhouetteBoard &board) {
  const Exact3 a = exact_place(items, row_ax, row_rest_ax, pairs.item[pair], sample),
               b = exact_place(items, row_bx, row_rest_bx, pairs.item[pair], sample), edge = cross(a, b);
  for (; bits != 0; bits &= bits - 1) {
    const int k = std::countr_zero(bits);
    const std::uint32_t d = first + static_cast<std::uint32_t>(k);
    const Exact3 diode{board.exact_m[0][d] - sample.exact[0], board.exact_m[1][d] - sample.exact[1],
                       board.exact_m[2][d] - sample.exact[2]};
    const double volume = dot(edge, diode);
    beyond[k] = (pairs.turned[pair] != 0 ? volume > 0.0 : volume < 0.0) ? -1 : 0;
  }
  return beyond;
}

// Adds to the counts of the diodes of a pair's angle that lie beyond its line.
void count_pair(const Pairs &pairs, int pair, int amount, const Rows &items, const Sample &sample,
                const SilhouetteBoard &board, std::int32_t *counts) {
  const Floats line_x = all(pairs.line_x[pair]), line_y = all(pairs.line_y[pair]),
               offset = all(pairs.offset[pair]), near_line = all(pairs.near_line[pair]);
  const Ints amounts = all(amount), numbers = lane_numbers();
  // Of ranks from `first` on up to `end`.
  const auto count = [&](std::int32_t first, std::int32_t end) {
    for (std::int32_t d = first & ~(lanes - 1); d < end; d += lanes) {
      const auto at = static_cast<std::uint32_t>(d);
      const Floats f = line_x * load<Floats>(board.x_m + at) + line_y * load<Floats>(board.y_m + at) + offset;
      const Ints in_angle = (numbers >= first - d) & (numbers < end - d);
      Ints beyond = f < 0.0f;
      if (const std::uint32_t close = bits_of(in_angle & (absolute(f) < near_line)); close != 0) [[unlikely]]
        beyond = decide_close(pairs, pair, at, close, beyond, items, sample, board);
      store(counts + at, load<Ints>(counts + at) + (beyond & in_angle & amounts));
    }
  };
  const std::int32_t from = pairs.from[pair], to = pairs.to[pair];
  count(from, pairs.wraps[pair] != 0 ? static_cast<std::int32_t>(board.diodes) : to);
  if (pairs.wraps[pair] != 0)
    count(0, to);
}

void sweep_over(const ItemList &list, const Sample &sample, const SilhouetteBoard &board, Pairs &pairs,
                Sweep &sweep) {
  const Rows items = list.all();
  pairs.count = 0;
  for (int i = 0; i < list.count; i += lanes)
    add_pairs(find_crossings(items, i, list.count, sample, board, sweep), i, pairs);
  if (pairs.count > 0)
    touch(sweep);
  for (int pair = 0; pair < pairs.count; ++pair) {
    int amount = pairs.amount[pair];
    if (pairs.is_unsure[pair] != 0) {
      const int weight = exact_weight(items, pairs.item[pair], sample, board);
      amount = pairs.turned[pair] != 0 ? weight : -weight;
    }
    if (amount != 0)
      count_pair(pairs, pair, amount, items, sample, board, sweep.counts);
  }
}

// A sample whose surface some diodes may stand behind: the others, a bit each.
void find_facing(const Sample &sample, const SilhouetteBoard &board, std::int32_t *faces) {
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

// ---- A tile

// What a tile's samples have in common.
struct Tile {
  const SilhouetteBoard &board;
  ListedBlock *edges, *hidden;
  std::uint32_t edge_blocks, hidden_blocks;
  ItemList items;                             // of one segment
  std::uint32_t gathered_first, gathered_end; // the blocks in it
};

void gather_segment(Tile &tile, std::uint32_t first) {
  if (tile.gathered_end > 0 && tile.gathered_first == first)
    return;
  tile.gathered_first = first;
  tile.gathered_end = gather(tile.board.edges, tile.edges, first, tile.edge_blocks, tile.items);
}

// By the tetrahedra of sample, lens, diode and each end: for any sample, and diodes anywhere.
void decide_exactly(Tile &tile, const Sample &sample, int hidden, Sweep &sweep) {
  const SilhouetteBoard &board = tile.board;
  for (std::int32_t &count : sweep.counts)
    count = hidden;
  for (std::uint32_t i = 0; i < board.piercer_count; ++i) {
    const shader::Piercer &piercer = board.piercers[i];
    double plane[4];
    for (int k = 0; k < 4; ++k)
      plane[k] = static_cast<double>(piercer.plane_hi[k]) + static_cast<double>(piercer.plane_lo[k]);
    const int side = exact_side(plane, sample, board);
    for (std::uint32_t d = 0; d < board.diodes; ++d)
      sweep.counts[board.rank_of_bit[d]] += (piercer.diodes[d / 32] >> d % 32 & 1u) != 0 ? side : 0;
  }
  const Exact3 lens{-sample.exact[0], -sample.exact[1], static_cast<double>(board.lens_z) - sample.exact[2]};
  Shaft shaft = no_shaft();
  add_sample(sample, board, shaft);
  const Ways ways = ways_of(shaft, board);
  ItemList list;
  for (std::uint32_t first = 0; first < tile.edge_blocks; first = tile.gathered_end) {
    gather_segment(tile, first);
    narrow(tile.items, ways, may_matter, list);
    const Rows items = list.all();
    for (int i = 0; i < list.count; ++i) {
      if (static_cast<std::uint32_t>(list.rows[row_first][i]) == sample.own ||
          static_cast<std::uint32_t>(list.rows[row_second][i]) == sample.own)
        continue;
      if (const int weight = exact_weight(items, i, sample, board); weight != 0)
        cross_triangles(exact_place(items, row_ax, row_rest_ax, i, sample),
                        exact_place(items, row_bx, row_rest_bx, i, sample), lens, weight, sample, board,
                        sweep.counts);
    }
  }
}

// The sample's bits; returns false where a count below zero tells that something was left out. Such a count
// means nothing of a diode behind the sample's own surface.
bool find_bits(const Sweep &sweep, const std::int32_t *faces, const SilhouetteBoard &board,
               std::uint32_t *words) {
  std::uint32_t below_zero = 0;
  std::memset(words, 0, shader::bundles_per_window * sizeof(*words));
  for (std::uint32_t d = 0; d < board.diodes; d += lanes) {
    const Ints ranks = load<Ints>(board.rank_of_bit + d);
    const Ints count = gathered(sweep.counts, ranks), facing = gathered(faces, ranks);
    words[d / 32] |= bits_of((count == 0) & facing) << d % 32;
    below_zero |= bits_of((count < 0) & facing);
  }
  return below_zero == 0;
}

void finish(Tile &tile, const Sample &sample, Sweep &sweep, std::uint32_t *words) {
  const SilhouetteBoard &board = tile.board;
  const bool turns_away = !board.all_facing && may_turn_away(sample, board);
  const int hidden = count_hidden(board.hidden, tile.hidden, tile.hidden_blocks, sample, board),
            base = sweep.base + hidden;
  if (!sweep.is_touched && !sweep.is_unclear && !turns_away && base == 0)
    return;
  alignas(64) std::int32_t faces[most_diodes];
  std::memset(faces, -1, sizeof(faces));
  if (turns_away)
    find_facing(sample, board, faces);
  touch(sweep);
  if (base != 0)
    for (std::int32_t &count : sweep.counts)
      count += base;
  if (!sweep.is_unclear && find_bits(sweep, faces, board, words))
    return;
  decide_exactly(tile, sample, hidden, sweep);
  find_bits(sweep, faces, board, words);
}

// Neighbouring samples of a tile.
void decide_block(Tile &tile, const Sample *samples, const int (&within)[block_samples], TileBits &bits) {
  const SilhouetteBoard &board = tile.board;
  Shaft shaft = no_shaft();
  for (const int i : within)
    if (samples[i].sees)
      add_sample(samples[i], board, shaft);
  if (!shaft.any)
    return;
  const Ways ways = ways_of(shaft, board);
  Sweep sweeps[block_samples];
  for (int k = 0; k < block_samples; ++k)
    if (samples[within[k]].sees)
      begin_sweep(samples[within[k]], board, sweeps[k]);
  ItemList list;
  Pairs pairs;
  for (std::uint32_t first = 0; first < tile.edge_blocks && !board.exact_only; first = tile.gathered_end) {
    gather_segment(tile, first);
    narrow(tile.items, ways, may_matter, list);
    for (int k = 0; k < block_samples; ++k)
      if (samples[within[k]].sees && !sweeps[k].is_unclear)
        sweep_over(list, samples[within[k]], board, pairs, sweeps[k]);
  }
  for (int k = 0; k < block_samples; ++k)
    if (samples[within[k]].sees)
      finish(tile, samples[within[k]], sweeps[k], bits.words[within[k]]);
}

void count_missing(const SilhouetteBoard &board, const Sample *samples, TileBits &bits) {
  std::uint32_t any = 0;
  for (std::uint32_t i = 0; i < shader::tile_samples; ++i) {
    bits.missing[i] = 0;
    for (std::uint32_t w = 0; samples[i].sees && w < board.bundles; ++w)
      bits.missing[i] += static_cast<std::uint32_t>(std::popcount(board.shining[w] & ~bits.words[i][w]));
    any |= bits.missing[i];
  }
  bits.is_shaded = any != 0;
}

void decide_tile(const SilhouetteBoard &board, const SampleSource &source, std::uint32_t number,
                 const TileMemory &memory, TileBits &bits) {
  Sample samples[shader::tile_samples];
  std::memset(bits.words, 0xff, sizeof(bits.words));
  bits.is_shaded = false;
  if (!find_samples(board, source, number, samples, bits))
    return;
  Shaft shaft = no_shaft();
  for (const Sample &sample : samples)
    if (sample.sees) {
      add_sample(sample, board, shaft);
      shaft.turns_away = shaft.turns_away || (!board.all_facing && may_turn_away(sample, board));
    }
  const Ways ways = ways_of(shaft, board);
  Tile tile{board,
            memory.edges,
            memory.hidden,
            list_items(board.edges, ways, may_matter, memory.edges),
            list_items(board.hidden, sights_of(shaft, board), may_hide, memory.hidden),
            {},
            0,
            0};
  if (tile.edge_blocks + tile.hidden_blocks == 0 && !shaft.turns_away && !board.leaves_none)
    return;
  for (int y = 0; y < tile_side; y += block_high)
    for (int x = 0; x < tile_side; x += block_wide) {
      int within[block_samples];
      for (int i = 0; i < block_samples; ++i)
        within[i] = (y + i / block_wide) * tile_side + x + i % block_wide;
      decide_block(tile, samples, within, bits);
    }
  count_missing(board, samples, bits);
}

} // namespace

extern const DecideTile decide_silhouettes;
const DecideTile decide_silhouettes = decide_tile;

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
