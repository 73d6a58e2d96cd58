// What the shaders of the shadow pass share: tiles, their parts and the lists of what is left to do.
#ifndef PMDSIM_LIT_GLSL
#define PMDSIM_LIT_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/constants.h"
#include "shaders/shadow/lit_interface.h"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer LitScenes { LitScene at; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Parts { TilePart at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Work {
  LitWork at;
  uint list[];
};

uint body_of(uvec2 scene, uint id) { return Words(LitScenes(scene).at.bodies).at[id]; }

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

uint entry_of(uvec2 work, uint list, uint parts, uint entry) { return Work(work).list[list * parts + entry]; }

// Adds a part to a list over which a workgroup a part will run.
void append(uvec2 work, uint list, uint parts, uint part) {
  Work to = Work(work);
  uint entry = atomicAdd(to.at.list[list].count, 1u);
  to.list[list * parts + entry] = part;
  atomicMax(to.at.list[list].x, min(entry + 1u, workgroups_per_row));
  atomicMax(to.at.list[list].z, entry / workgroups_per_row + 1u);
}

// The same, whoever says so first of those that say so of a part; `what` is not 0 and larger the later the list.
void append_once(uvec2 work, uint list, uint parts, uint part, uint what) {
  if (atomicExchange(Work(work).list[list_said * parts + part], what) != what)
    append(work, list, parts, part);
}

const uint no_part = 0xffffffffu;

// The part of this workgroup, or no_part.
uint part_of_workgroup(uvec2 work, uint list, uint parts) {
  uint entry = gl_WorkGroupID.z * workgroups_per_row + gl_WorkGroupID.x;
  return entry < Work(work).at.list[list].count ? entry_of(work, list, parts, entry) : no_part;
}

// What the sample sees, 0 where it is not there.
uint shape_of(TileSample at, Strip strip, uvec2 ids, bool tiled) {
  uint id_at = id_index(at.pixel, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, tiled);
  uint id = WordPairs(ids).at[at.is_there ? id_at : 0u].y;
  return at.is_there ? id : 0u;
}

#endif
