#pragma once
// The data of the host's raster, as plain arrays: its loops are compiled once for each instruction set, so
// they share no code with the rest of the program.

#include "shaders/shared/interface.h"

#include <cstddef>
#include <cstdint>

namespace pmdsim {

// Corners as shader::RasterVertex has them, in fragments of their raster block.
struct BlockTriangle {
  float x[3], y[3], inverse_depth[3];
  std::uint32_t id;
};

// Some rows of a strip. Depths and ids lie row by row, `stride` apart, with room for a vector behind each.
struct BandRows {
  std::uint32_t column, row; // of the strip's first fragment in its block
  std::uint32_t first, rows; // of the strip
  std::uint32_t columns, stride;
  float *depths;      // 0 where nothing is seen
  std::uint32_t *ids; // of triangles; no_triangle where nothing is seen
};

// How fragments become samples (shaders/shared/interface.h).
struct BandSamples {
  shader::Strip strip;
  const shader::TrianglePlane *planes;
  const shader::ChipPlace *chip; // where it is not nominal
  double slope[2];               // of a nominal one
  float first[2];                // as SampleGrid
  bool records;                  // with depths
  std::byte *samples;            // of the strip
};

// One for each instruction set.
struct RasterKernel {
  // Draws the listed triangles; the nearest wins, and the first of equally near ones.
  void (*draw)(const BandRows &band, const BlockTriangle *triangles, const std::uint32_t *listed,
               std::size_t count);
  // Leaves the samples' IDs or records.
  void (*leave)(const BandRows &band, const BandSamples &to);
};

} // namespace pmdsim
