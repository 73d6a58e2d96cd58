// Whether an occluder stands between a point and a diode. The point makes a cone of the occluder, in which a diode lies or does
// not: three planes through the point and an edge each, and the occluder's own plane, beyond which the diode must be. One set
// of functions for all who ask, and nothing in them may be fused: so they all get the same answer, to the last bit.
#ifndef PMDSIM_OCCLUSION_GLSL
#define PMDSIM_OCCLUSION_GLSL

#include "buffers.glsl"
#include "real.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Occluders { Occluder at[]; };

// A sample's point, and the shape that it lies on, which does not stand in its own light.
struct LitPoint {
  vec3 hi, lo;
  uint own;
};

// Affine functions of a diode's position D: dot(xyz, D) + w. The diode is behind the occluder where all are at least 0.
struct Cone {
  vec4 ab, bc, ca, beyond;
};

float precise_dot(vec3 a, vec3 b) {
  precise float x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
  precise float sum = x + y + z;
  return sum;
}

float affine_at(vec4 f, vec3 d) {
  precise float x = f.x * d.x, y = f.y * d.y, z = f.z * d.z;
  precise float sum = x + y + z + f.w;
  return sum;
}

vec3 precise_cross(vec3 a, vec3 b) {
  precise vec3 left = a.yzx * b.zxy, right = a.zxy * b.yzx;
  precise vec3 difference = left - right;
  return difference;
}

// The plane through the point and an edge from `from` (relative to the point) to `to`, inside where it is positive. The edge is
// taken in the same direction whichever triangle it belongs to, so that no light leaks between two that share it.
vec4 edge_plane(vec3 from, vec3 to, vec3 from_m, vec3 to_m, bool turned, float side) {
  vec3 start = turned ? to : from;
  precise vec3 along = turned ? from - to : to - from;
  vec3 normal = precise_cross(start, along);
  float offset = -precise_dot(normal, turned ? to_m : from_m);
  float way = turned ? -side : side;
  return vec4(way * normal, way * offset);
}

const vec4 behind_nothing = vec4(0.0, 0.0, 0.0, -1.0);

// How high the point lies over the occluder's plane, m; 0 where that is less than the rounding of the point and the plane.
float height_over(Occluder occluder, LitPoint point) {
  Real height = add(dot3(real3(occluder.plane_hi.xyz, occluder.plane_lo.xyz), real3(point.hi, point.lo)),
                    negate(real(occluder.plane_hi.w, occluder.plane_lo.w)));
  vec3 size = abs(point.hi);
  float rounding = 2.3e-13 * (abs(occluder.plane_hi.w) + size.x + size.y + size.z); // 2^-42: a pair of floats holds 48 bits
  float rounded = high(height);
  return abs(rounded) > rounding ? rounded : 0.0;
}

Cone cone_of(Occluder occluder, LitPoint point) {
  float height = height_over(occluder, point);
  float side = height < 0.0 ? 1.0 : -1.0;
  precise vec3 a = (occluder.a_hi.xyz - point.hi) + (occluder.a_lo.xyz - point.lo);
  precise vec3 b = (occluder.b_hi.xyz - point.hi) + (occluder.b_lo.xyz - point.lo);
  precise vec3 c = (occluder.c_hi.xyz - point.hi) + (occluder.c_lo.xyz - point.lo);
  Cone cone;
  cone.ab = edge_plane(a, b, occluder.a_hi.xyz, occluder.b_hi.xyz, (occluder.edges & 1u) != 0u, side);
  cone.bc = edge_plane(b, c, occluder.b_hi.xyz, occluder.c_hi.xyz, (occluder.edges & 2u) != 0u, side);
  cone.ca = edge_plane(c, a, occluder.c_hi.xyz, occluder.a_hi.xyz, (occluder.edges & 4u) != 0u, side);
  // A diode that the occluder touches is not behind it.
  precise float offset = -side * occluder.plane_hi.w - 3e-7 * abs(occluder.plane_hi.w) - 1e-30;
  cone.beyond = height == 0.0 || occluder.id == point.own ? behind_nothing : vec4(side * occluder.plane_hi.xyz, offset);
  return cone;
}

// At least 0 where the occluder stands between the point and a diode at `d`.
float depth_in(Cone cone, vec3 d) {
  return min(min(affine_at(cone.ab, d), affine_at(cone.bc, d)), min(affine_at(cone.ca, d), affine_at(cone.beyond, d)));
}

#endif
