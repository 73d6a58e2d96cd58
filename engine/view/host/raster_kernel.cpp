// The loops of the host's raster. Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET its name;
// see engine/CMakeLists.txt. Samples that lie on an edge go to one of both sides as on lavapipe, and depths
// are rounded as there, so that either raster leaves the same bits.
#include "engine/view/host/raster_kernel.h"

#include "engine/model/lanes.h"
#include "engine/sampling/host/sample_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr std::int32_t steps = 256; // of the raster's grid a fragment

// An edge's half-plane a x + b y + c >= 0, with x and y in whole fragments from the strip's first one.
struct HalfPlane {
  std::int32_t a, b;
  std::int64_t c;
};

// From the block's first fragment, not the strip's, which would change how floats round it.
struct Depth {
  float at_origin, along_x, along_y;
};

struct DrawnTriangle {
  HalfPlane sides[3];
  Depth depth;
  std::uint32_t id;
  std::int32_t low[2], high[2]; // columns and rows, both ends included
  bool is_wide;
};

struct Corner {
  float x, y, z;
  std::int32_t grid_x, grid_y;
};

// An edge's own samples belong to what lies to its right, or below it.
HalfPlane half_plane(const Corner &from, const Corner &to) {
  const std::int32_t a = to.grid_y - from.grid_y, b = from.grid_x - to.grid_x;
  const std::int64_t c = -(std::int64_t{a} * from.grid_x + std::int64_t{b} * from.grid_y);
  const bool holds_edge = a > 0 || (a == 0 && b > 0);
  return {a, b, (c - (holds_edge ? 0 : 1)) >> 8};
}

Depth depth_of(const Corner &v0, const Corner &v1, const Corner &v2) {
  const float dx01 = v0.x - v1.x, dy01 = v0.y - v1.y, dx20 = v2.x - v0.x, dy20 = v2.y - v0.y;
  const float per_area = 1.0f / (dx01 * dy20 - dy01 * dx20);
  const float dx20_per = dx20 * per_area, dy20_per = dy20 * per_area, dx01_per = dx01 * per_area,
              dy01_per = dy01 * per_area;
  const float dz01 = v0.z - v1.z, dz20 = v2.z - v0.z;
  const float along_x = dz01 * dy20_per - dz20 * dy01_per, along_y = dz20 * dx01_per - dz01 * dx20_per;
  return {v0.z - (along_x * (v0.x - 0.5f) + along_y * (v0.y - 0.5f)), along_x, along_y};
}

// False where the triangle covers no fragment's middle.
bool prepare(const BlockTriangle &triangle, const BandRows &band, DrawnTriangle &to) {
  Corner corners[3];
  for (int k = 0; k < 3; ++k) {
    Corner &corner = corners[k];
    corner.x = triangle.x[k];
    corner.y = triangle.y[k];
    corner.z = triangle.inverse_depth[k];
    corner.grid_x =
        static_cast<std::int32_t>((corner.x - static_cast<float>(band.column)) * steps) - steps / 2;
    corner.grid_y = static_cast<std::int32_t>((corner.y - static_cast<float>(band.row)) * steps) - steps / 2;
  }
  const auto [low_x, high_x] = std::minmax({corners[0].grid_x, corners[1].grid_x, corners[2].grid_x});
  const auto [low_y, high_y] = std::minmax({corners[0].grid_y, corners[1].grid_y, corners[2].grid_y});
  const auto first = static_cast<std::int32_t>(band.first);
  to.low[0] = std::max((low_x + steps - 1) >> 8, 0);
  to.low[1] = std::max((low_y + steps - 1) >> 8, first);
  to.high[0] = std::min(high_x >> 8, static_cast<std::int32_t>(band.columns) - 1);
  to.high[1] = std::min(high_y >> 8, first + static_cast<std::int32_t>(band.rows) - 1);
  if (to.low[0] > to.high[0] || to.low[1] > to.high[1])
    return false;
  const std::int64_t area =
      std::int64_t{corners[1].grid_x - corners[0].grid_x} * (corners[2].grid_y - corners[0].grid_y) -
      std::int64_t{corners[2].grid_x - corners[0].grid_x} * (corners[1].grid_y - corners[0].grid_y);
  if (area == 0)
    return false;
  if (area > 0)
    std::swap(corners[1], corners[2]);
  for (int k = 0; k < 3; ++k)
    to.sides[k] = half_plane(corners[k], corners[(k + 1) % 3]);
  to.depth = depth_of(corners[0], corners[1], corners[2]);
  to.id = triangle.id;
  constexpr std::int32_t most = 1024 * steps;
  to.is_wide = to.high[0] - to.low[0] >= lanes || high_x - low_x > most || high_y - low_y > most;
  return true;
}

inline void draw_lanes(const Ints &inside, const Floats &z, std::uint32_t id, const BandRows &band,
                       std::size_t at) {
  const Floats depth = load<Floats>(band.depths + at);
  const Ints nearer = inside & ~(z <= depth);
  store(band.depths + at, nearer ? z : depth);
  const Ints ids = load<Ints>(band.ids + at);
  store(band.ids + at, nearer ? all(static_cast<std::int32_t>(id)) : ids);
}

inline std::size_t place_in(const BandRows &band, std::int32_t column, std::int32_t row) {
  return std::size_t{static_cast<std::uint32_t>(row) - band.first} * band.stride +
         static_cast<std::uint32_t>(column);
}

// Numbers in the block, as floats.
inline Floats columns_in_block(std::int32_t first, const BandRows &band) {
  return __builtin_convertvector(lane_numbers() + (first + static_cast<std::int32_t>(band.column)), Floats);
}

inline Floats row_in_block(std::int32_t row, const BandRows &band) {
  return all(static_cast<float>(row + static_cast<std::int32_t>(band.row)));
}

void draw_narrow(const DrawnTriangle &t, const BandRows &band) {
  Ints heights[3];
  for (int k = 0; k < 3; ++k) {
    const HalfPlane &side = t.sides[k];
    heights[k] =
        lane_numbers() * side.a +
        static_cast<std::int32_t>(side.c + std::int64_t{side.a} * t.low[0] + std::int64_t{side.b} * t.low[1]);
  }
  const Floats along_row =
      multiply_add(columns_in_block(t.low[0], band), all(t.depth.along_x), all(t.depth.at_origin));
  for (std::int32_t row = t.low[1]; row <= t.high[1]; ++row) {
    const Ints inside = (heights[0] | heights[1] | heights[2]) >= 0;
    if (bits_of(inside) != 0)
      draw_lanes(inside, multiply_add(row_in_block(row, band), all(t.depth.along_y), along_row), t.id, band,
                 place_in(band, t.low[0], row));
    for (int k = 0; k < 3; ++k)
      heights[k] += t.sides[k].b;
  }
}

// Columns of a row in which the triangle may be, by doubles with a fragment to spare.
void narrow_columns(const DrawnTriangle &t, std::int32_t row, std::int32_t &low, std::int32_t &high) {
  for (const HalfPlane &side : t.sides) {
    if (side.a == 0)
      continue;
    const double at = -(static_cast<double>(side.c) + static_cast<double>(side.b) * row) / side.a;
    if (side.a > 0)
      low = std::max(low, static_cast<std::int32_t>(std::max(at, -1e6)) - 1);
    else
      high = std::min(high, static_cast<std::int32_t>(std::min(at, 1e6)) + 1);
  }
}

void draw_wide(const DrawnTriangle &t, const BandRows &band) {
  const Floats along_x = all(t.depth.along_x), along_y = all(t.depth.along_y),
               at_origin = all(t.depth.at_origin);
  for (std::int32_t row = t.low[1]; row <= t.high[1]; ++row) {
    const Floats at_row = row_in_block(row, band);
    std::int32_t low = t.low[0], high = t.high[0];
    narrow_columns(t, row, low, high);
    for (std::int32_t column = low; column <= high; column += lanes) {
      Ints outside{};
      for (const HalfPlane &side : t.sides) {
        constexpr std::int64_t far = 1 << 30; // from the line: a vector's columns make no difference there
        const std::int64_t height = side.c + std::int64_t{side.a} * column + std::int64_t{side.b} * row;
        outside |= lane_numbers() * side.a + static_cast<std::int32_t>(std::clamp(height, -far, far));
      }
      const Ints inside = outside >= 0;
      if (bits_of(inside) != 0)
        draw_lanes(
            inside,
            multiply_add(at_row, along_y, multiply_add(columns_in_block(column, band), along_x, at_origin)),
            t.id, band, place_in(band, column, row));
    }
  }
}

void draw(const BandRows &band, const BlockTriangle *triangles, const std::uint32_t *listed,
          std::size_t count) {
  DrawnTriangle drawn;
  for (std::size_t i = 0; i < count; ++i)
    if (prepare(triangles[listed[i]], band, drawn))
      drawn.is_wide ? draw_wide(drawn, band) : draw_narrow(drawn, band);
}

double sum_of_pair(float hi, float lo) { return static_cast<double>(hi) + static_cast<double>(lo); }

// As shaders/view/meet.glsl.
double depth_on_plane(const double (&ray)[2], const shader::TrianglePlane &plane) {
  const auto of = [&](int k) { return sum_of_pair(plane.plane_hi[k], plane.plane_lo[k]); };
  const double facing = of(0) * ray[0] + of(1) * ray[1] + of(2), offset = of(3);
  const auto f = static_cast<float>(facing), o = static_cast<float>(offset);
  const bool meets = f > 0.0f ? o > 0.0f : f < 0.0f && o < 0.0f;
  const double least = static_cast<double>(plane.along_min), most = static_cast<double>(plane.along_max);
  if (!meets)
    return most;
  const double depth = offset / facing;
  return depth >= least ? std::min(depth, most) : least;
}

void leave(const BandRows &band, const BandSamples &to) {
  const shader::Strip &strip = to.strip;
  for (std::uint32_t row = band.first; row < band.first + band.rows; ++row) {
    const std::uint32_t *ids = band.ids + std::size_t{row - band.first} * band.stride;
    const std::uint32_t first_pixel =
        (strip.row + row / strip.samples) * strip.resolution_x + strip.column + 1;
    std::byte *const of_row = to.samples + std::size_t{row} * band.columns *
                                               (to.records ? sizeof(shader::uvec4) : sizeof(shader::uvec2));
    std::uint32_t pixel = first_pixel, within = 0;
    const double y = static_cast<double>(to.first[1] + 2.0f * static_cast<float>(row));
    for (std::uint32_t column = 0; column < band.columns; ++column) {
      const bool hit = ids[column] != shader::no_triangle;
      const std::uint32_t words[2] = {hit ? pixel : 0, hit ? ids[column] : 0};
      if (++within == strip.samples)
        within = 0, ++pixel;
      if (!to.records) {
        std::memcpy(of_row + column * sizeof(words), words, sizeof(words));
        continue;
      }
      double depth = 0.0;
      if (hit) {
        double ray[2];
        find_ray(to.chip, to.slope, static_cast<double>(to.first[0] + 2.0f * static_cast<float>(column)), y,
                 ray);
        depth = depth_on_plane(ray, to.planes[ids[column]]);
      }
      std::memcpy(of_row + std::size_t{2} * column * sizeof(words), words, sizeof(words));
      std::memcpy(of_row + std::size_t{2} * column * sizeof(words) + sizeof(words), &depth, sizeof(depth));
    }
  }
}

} // namespace

extern const RasterKernel raster_kernel;
const RasterKernel raster_kernel{draw, leave};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
