// What the shaders that decide for each sample and diode share.
#ifndef PMDSIM_LIT_DECIDE_GLSL
#define PMDSIM_LIT_DECIDE_GLSL

#include "shaders/shadow/lit.glsl"
#include "shaders/shadow/occlusion.glsl"

layout(push_constant, std430) uniform Constants { LitDecideConstants constants; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Bundles { BundleDiodes at; };
layout(constant_id = constant_tiled) const uint tiled = 0;

// A sample of the part, or one that is not to be decided.
struct PartSample {
  bool is_there;
  uint i;
  LitPoint point;
  vec4 surface; // how high a diode stands over its plane, an affine function as in Cone
};

PartSample part_sample(uint part_index, uint within, DiodeFrame frame) {
  Strip strip = constants.strip;
  TileSample at = tile_sample(strip, part_index / parts_per_tile, within);
  Real3 position = load_position(constants.position, at.i);
  vec3 hi = high3(position), lo = rest3(position);
  Parts parts = Parts(constants.parts);
  bool is_there = at.is_there && hi != vec3(0.0) && hi.z >= parts.at[part_index].nearest_m &&
                  hi.z < parts.at[part_index].farthest_m;
  uint id = is_there ? shape_of(at, strip, constants.ids, tiled != 0) : 0u;
  TrianglePlane plane = Planes(LitScenes(constants.scene).at.planes).at[id];
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  Real offset = add(dot3(normal, real3(frame.centre, vec3(0.0))), negate(real(plane.plane_hi.w, plane.plane_lo.w)));
  return PartSample(is_there, at.i, LitPoint(hi, lo, id, body_of(constants.scene, id)), vec4(plane.plane_hi.xyz, high(offset)));
}

DiodeFrame diode_frame() {
  vec4 centre = Bundles(constants.diodes).at.centre;
  return DiodeFrame(centre.xyz, centre.w);
}

#endif
