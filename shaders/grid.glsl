// Samples that are an even grid over the chip: which one an invocation is, and where its point is.
#ifndef PMDSIM_GRID_GLSL
#define PMDSIM_GRID_GLSL

#include "buffers.glsl"
#include "chip.glsl"
#include "meet.glsl"

// (i % columns, i / columns) without the division, which lavapipe does lane by lane; exact for i < 2^21.
uvec2 row_by_row(uint i, uint columns, float inverse_columns) {
  uint row = uint((float(i) + 0.5) * inverse_columns);
  return uvec2(i - row * columns, row);
}

Real3 ray_of(uvec2 sample_at, SampleGrid grid, uvec2 chip, bool general) {
  return grid_ray(grid.slope, chip, grid.first + 2.0 * vec2(sample_at), general);
}

#endif
