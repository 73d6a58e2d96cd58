// What the shaders that decide for each sample and diode share: one workgroup is one part of a tile.
#ifndef PMDSIM_LIT_DECIDE_GLSL
#define PMDSIM_LIT_DECIDE_GLSL

#include "lit.glsl"
#include "occlusion.glsl"

layout(local_size_x = tile_samples) in;
layout(push_constant, std430) uniform Constants { LitDecideConstants constants; };
layout(constant_id = constant_lit_tiled) const uint tiled = 0;

// A sample of the part, or one that is not to be decided.
struct PartSample {
  bool is_there;
  uint i;
  LitPoint point;
  vec4 surface; // its plane, turned to the lens
};

PartSample part_sample(uint part_index) {
  Strip strip = constants.strip;
  TileSample at = tile_sample(strip, part_index / parts_per_tile, gl_LocalInvocationID.x);
  vec3 hi = load_vec3(constants.position_hi, at.i), lo = load_vec3(constants.position_lo, at.i);
  uint tag_at = tag_index(at.pixel, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, tiled != 0);
  uvec2 tag = Tags(constants.tags).at[at.is_there ? tag_at : 0u];
  Parts parts = Parts(constants.parts);
  bool is_there = at.is_there && hi != vec3(0.0) && hi.z >= parts.at[part_index].nearest_m &&
                  hi.z < parts.at[part_index].farthest_m;
  uint id = is_there ? tag.y : 0u;
  return PartSample(is_there, at.i, LitPoint(hi, lo, id), Planes(LitScenes(constants.scene).at.planes).at[id].plane_hi);
}

// How high a diode stands over the sample's surface, m.
float height_of_diode(PartSample at, vec3 diode) { return affine_at(vec4(at.surface.xyz, -at.surface.w), diode); }

#endif
