// Samples as the shadow passes take them: in tiles of pixels.
#ifndef PMDSIM_TILES_GLSL
#define PMDSIM_TILES_GLSL

#include "shaders/sampling/grid.glsl"
#include "shaders/shared/buffers.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/meet.glsl"

layout(constant_id = constant_tiled) const uint tiled = 0;
layout(constant_id = constant_depth_records) const uint depth_records = 0; // samples are these, row by row, and the strip counts them
layout(constant_id = constant_general_chip) const uint general_chip = 0;

uvec2 tiles_of(Strip strip) { return (uvec2(strip.columns, strip.rows) + tile_side - 1u) / tile_side; }

// A sample of a tile: whether it is there, in the strip's pixels, and its index.
struct TileSample {
  bool is_there;
  uvec2 pixel;
  uvec2 subsample;
  uint i;
};

TileSample tile_sample(Strip strip, uint tile, uint within) {
  uvec2 tiles = tiles_of(strip);
  uint subsample = tile / (tiles.x * tiles.y);
  uint of_subsample = tile - subsample * tiles.x * tiles.y;
  uvec2 pixel = uvec2(of_subsample % tiles.x, of_subsample / tiles.x) * tile_side +
                uvec2(within % tile_side, within / tile_side);
  bool is_there = pixel.x < strip.columns && pixel.y < strip.rows;
  return TileSample(is_there, pixel, uvec2(subsample % strip.samples, subsample / strip.samples),
                    is_there ? subsample * strip.padded_pixels + pixel.y * strip.columns + pixel.x : 0u);
}

// Where the sample lies, camera frame; the lens itself where it sees nothing. `slope` and `chip` are those of depth records.
Real3 point_of(TileSample at, Strip strip, uvec2 position, uvec2 records, vec4 slope, uvec2 chip) {
  if (depth_records == 0)
    return load_position(position, at.i);
  vec2 place = vec2(2 * ivec2(uvec2(strip.column, strip.row) + at.pixel) + 1 - ivec2(strip.resolution_x, strip.resolution_y));
  return point_at_depth(grid_ray(slope, chip, place, general_chip != 0), load_record_depth(records, at.i));
}

// The shape that the sample sees, 0 where the sample is not there.
uint shape_of(TileSample at, Strip strip, uvec2 ids) {
  if (depth_records != 0)
    return load_record_ids(ids, at.i).y;
  uint id_at = id_index(at.pixel, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, tiled != 0);
  uint id = WordPairs(ids).at[at.is_there ? id_at : 0u].y;
  return at.is_there ? id : 0u;
}

// The entry of this workgroup in a WorkList.
uint entry_of_workgroup() { return gl_WorkGroupID.z * workgroups_per_row + gl_WorkGroupID.y; }

#endif
