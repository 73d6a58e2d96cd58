// Tests of a whole part of a tile with all the diodes in a box at once. They may say "perhaps" too often, never too seldom.
#ifndef PMDSIM_LIT_GATHER_GLSL
#define PMDSIM_LIT_GATHER_GLSL

#include "lit.glsl"
#include "lit_walk.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { LitGatherConstants constants; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer DiodeBoxes { DiodeBox at[]; };

// The values of an affine function in a box, rounding included.
struct Range {
  float low, high;
};

Range range_of(vec3 gradient, float offset, vec3 low, vec3 high) {
  vec3 centre = 0.5 * (low + high), half_size = 0.5 * (high - low);
  float middle = dot(gradient, centre) + offset;
  float spread = dot(abs(gradient), half_size);
  float rounding = 1e-6 * (dot(abs(gradient), abs(centre) + half_size) + abs(offset));
  return Range(middle - spread - rounding, middle + spread + rounding);
}

// An occluder can only block what lies on the other side of its plane.
bool is_between(Occluder occluder, TilePart part, DiodeBox box) {
  vec4 plane = occluder.plane_hi;
  Range points = range_of(plane.xyz, -plane.w, part.low.xyz, part.high.xyz);
  Range diodes = range_of(plane.xyz, -plane.w, box.low.xyz, box.high.xyz);
  return (points.low < 0.0 && diodes.high > 0.0) || (points.high > 0.0 && diodes.low < 0.0);
}

bool may_block(Occluder occluder, TilePart part, DiodeBox box, Shaft shaft) {
  vec3 a = occluder.a_hi.xyz, b = occluder.b_hi.xyz, c = occluder.c_hi.xyz;
  vec3 low = min(min(a, b), c), high = max(max(a, b), c);
  low -= 1.2e-7 * abs(low);
  high += 1.2e-7 * abs(high);
  return may_meet(shaft, low, high) && is_between(occluder, part, box);
}

// What lies in or below the planes of all the part's own surfaces does not block them.
bool rises_over_own(TilePart part, Occluder occluder) {
  Real3 a = real3(occluder.a_hi.xyz, occluder.a_lo.xyz), b = real3(occluder.b_hi.xyz, occluder.b_lo.xyz),
        c = real3(occluder.c_hi.xyz, occluder.c_lo.xyz);
  bool rises = false;
  for (uint k = 0; k < part.own; ++k) {
    TrianglePlane plane = Planes(LitScenes(constants.scene).at.planes).at[part.own_ids[k]];
    Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
    Real offset = negate(real(plane.plane_hi.w, plane.plane_lo.w));
    float height = max(max(high(add(dot3(normal, a), offset)), high(add(dot3(normal, b), offset))),
                       high(add(dot3(normal, c), offset)));
    rises = rises || height > 2.3e-13 * abs(plane.plane_hi.w);
  }
  return rises;
}

// Whether all diodes stand in front of all surfaces.
bool all_face(TilePart part, DiodeBox box) {
  if (part.own > own_shapes)
    return false;
  bool facing = true;
  for (uint k = 0; k < part.own; ++k) {
    vec4 plane = Planes(LitScenes(constants.scene).at.planes).at[part.own_ids[k]].plane_hi;
    facing = facing && range_of(plane.xyz, -plane.w, box.low.xyz, box.high.xyz).low > 0.0;
  }
  return facing;
}

#endif
