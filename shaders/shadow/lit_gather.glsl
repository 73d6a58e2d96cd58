// Tests of a whole part of a tile with all the diodes in a box at once. They may say "perhaps" too often, never too seldom.
#ifndef PMDSIM_LIT_GATHER_GLSL
#define PMDSIM_LIT_GATHER_GLSL

#include "shaders/shadow/lit.glsl"
#include "shaders/shadow/lit_walk.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { LitGatherConstants constants; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer DiodeBoxes { DiodeBox at[]; };

Shaft shaft_of(TilePart part, DiodeBox box) { return shaft_between(part.low.xyz, part.high.xyz, box.low.xyz, box.high.xyz); }

// The values of plane.xyz . p - plane.w in a box, rounding included.
struct Range {
  float low, high;
};

Range heights(vec4 plane, vec3 low, vec3 high) {
  vec3 centre = 0.5 * (low + high), half_size = 0.5 * (high - low);
  float middle = dot(plane.xyz, centre) - plane.w;
  float spread = dot(abs(plane.xyz), half_size);
  float rounding = 1e-6 * (dot(abs(plane.xyz), abs(centre) + half_size) + abs(plane.w));
  return Range(middle - spread - rounding, middle + spread + rounding);
}

// An occluder can only block what lies on the other side of its plane. Of a convex body only those count that show their front
// to the diode, and none for what lies on the body itself. `points` are the heights of the part's.
bool is_between(vec4 plane, uint body, Range points, TilePart part, DiodeBox box) {
  Range diodes = heights(plane, box.low.xyz, box.high.xyz);
  bool from_behind = points.low < 0.0 && diodes.high > 0.0, from_front = points.high > 0.0 && diodes.low < 0.0;
  return body == no_body ? from_behind || from_front : from_behind && body != part.body;
}

// How high the diodes stand at least over all surfaces of the part, m; at most 0 where not all need stand in front of all.
float lowest_diode(TilePart part, DiodeBox box) {
  float lowest = part.own > own_shapes ? 0.0 : 1e30;
  [[unroll]] for (uint k = 0; k < own_shapes; ++k)
    if (k < part.own) {
      vec4 plane = Planes(LitScenes(constants.scene).at.planes).at[part.own_ids[k]].plane_hi;
      lowest = min(lowest, heights(plane, box.low.xyz, box.high.xyz).low);
    }
  return lowest;
}

#endif
