// Samples that are an even grid over the chip: which one an invocation is, and where its ray goes.
#ifndef PMDSIM_GRID_GLSL
#define PMDSIM_GRID_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/sampling/chip.glsl"

// (i % columns, i / columns) without the division, which lavapipe does lane by lane: a float's quotient is off by one at most,
// of fewer than 2^21 rows.
uvec2 row_by_row(uint i, uint columns, float inverse_columns) {
  uint row = uint(float(i) * inverse_columns);
  row -= row * columns > i ? 1u : 0u;
  uint column = i - row * columns;
  return column < columns ? uvec2(column, row) : uvec2(column - columns, row + 1u);
}

Real3 ray_of(uvec2 sample_at, SampleGrid grid, uvec2 chip, bool general) {
  return grid_ray(grid.slope, chip, grid.first + 2.0 * vec2(sample_at), general);
}

#endif
