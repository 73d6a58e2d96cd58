// What the shaders of the lit pass share: tiles, their parts and the lists of what is left to do.
#ifndef PMDSIM_LIT_GLSL
#define PMDSIM_LIT_GLSL

#include "buffers.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer LitScenes { LitScene at; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Parts { TilePart at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Work {
  LitWork at;
  uint list[];
};

uint body_of(uvec2 scene, uint id) { return Words(LitScenes(scene).at.bodies).at[id]; }

const uint parts_per_tile = 2;

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

// Where the lists begin, each of `parts` words.
uint tried_list(uint parts, uint bundle) { return parts * (1u + bundle); }
uint traced_list(uint parts, uint bundle) { return parts * (1u + bundles_per_window + bundle); }
uint walked_list(uint parts, uint bundle) { return parts * (1u + 2u * bundles_per_window + bundle); }

// Of an entry of `open` and a bundle: the number of candidates comes first.
uint candidate_slot(uint entry, uint bundles, uint bundle) { return entry * bundles + bundle; }
const uint slot_words = largest_candidates + 1;

#endif
