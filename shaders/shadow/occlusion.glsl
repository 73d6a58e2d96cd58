// Whether an occluder stands between a point and a diode. The point makes a cone of the occluder, in which a diode lies or does
// not: three planes through the point and an edge each, and the occluder's own plane, beyond which the diode must be. Nothing
// in them may be fused: so two triangles that share an edge get the same answer about it, to the last bit.
#ifndef PMDSIM_OCCLUSION_GLSL
#define PMDSIM_OCCLUSION_GLSL

#include "shaders/shadow/occluder.h"
#include "shaders/shared/real.glsl"

// A sample's point, and the shape that it lies on, which does not stand in its own light.
struct LitPoint {
  vec3 hi, lo;
  uint own;
};

// Where diodes are measured from: a place among them, and how far they stand from it at most, along each axis, m.
struct DiodeFrame {
  vec3 centre;
  float reach;
};

// Affine functions of a diode's place d in its frame: dot(xyz, d) + w. The diode is behind the occluder where all are at
// least 0.
struct Cone {
  vec4 ab, bc, ca, beyond;
};

float affine_at(vec4 f, vec3 d) {
  precise float x = f.x * d.x, y = f.y * d.y, z = f.z * d.z;
  precise float sum = x + y + z + f.w;
  return sum;
}

float size_of(vec3 a) { return abs(a.x) + abs(a.y) + abs(a.z); }

// The plane through the point and an edge, corners relative to the point, inside where it is positive. The edge is taken in
// the same direction whichever triangle it belongs to, so that no light leaks between two that share it. `centre` is the
// diodes', relative to the point.
vec4 edge_plane(Real3 from, Real3 to, bool turned, float side, Real3 centre) {
  Real3 start = from, end = to;
  if (turned) {
    start = to;
    end = from;
  }
  Real3 normal = cross3(start, subtract3(end, start));
  float way = turned ? -side : side;
  return vec4(way * high3(normal), way * high(dot3(normal, centre)));
}

const float pair_rounding = 2.3e-13; // 2^-42: a pair of floats holds 48 bits
const vec4 behind_nothing = vec4(0.0, 0.0, 0.0, -1.0);

// How high the point lies over the occluder's plane, m; 0 where that is less than the rounding of the point and the plane.
float height_over(Occluder occluder, LitPoint point, float world_rounding) {
  Real height = add(dot3(real3(occluder.plane_hi.xyz, occluder.plane_lo.xyz), real3(point.hi, point.lo)),
                    negate(real(occluder.plane_hi.w, occluder.plane_lo.w)));
  float rounded = high(height);
  return abs(rounded) > pair_rounding * (abs(occluder.plane_hi.w) + size_of(point.hi)) + world_rounding ? rounded : 0.0;
}

// The offset of the occluder's plane from the diodes' centre, m.
float offset_from(Occluder occluder, DiodeFrame frame) {
  Real3 normal = real3(occluder.plane_hi.xyz, occluder.plane_lo.xyz);
  return high(add(real(occluder.plane_hi.w, occluder.plane_lo.w), negate(dot3(normal, real3(frame.centre, vec3(0.0))))));
}

Cone cone_of(Occluder occluder, LitPoint point, DiodeFrame frame, float world_rounding) {
  float height = height_over(occluder, point, world_rounding);
  float side = height < 0.0 ? 1.0 : -1.0;
  Real3 place = real3(point.hi, point.lo);
  Real3 a = subtract3(real3(occluder.a_hi.xyz, occluder.a_lo.xyz), place);
  Real3 b = subtract3(real3(occluder.b_hi.xyz, occluder.b_lo.xyz), place);
  Real3 c = subtract3(real3(occluder.c_hi.xyz, occluder.c_lo.xyz), place);
  Real3 centre = subtract3(real3(frame.centre, vec3(0.0)), place);
  Cone cone;
  cone.ab = edge_plane(a, b, (occluder.edges & 1u) != 0u, side, centre);
  cone.bc = edge_plane(b, c, (occluder.edges & 2u) != 0u, side, centre);
  cone.ca = edge_plane(c, a, (occluder.edges & 4u) != 0u, side, centre);
  // A diode that the occluder touches is not behind it: by the rounding of `affine_at`, with some to spare.
  float offset = offset_from(occluder, frame);
  precise float beyond = -side * offset - 3e-7 * (abs(offset) + frame.reach) - world_rounding - 1e-30;
  cone.beyond = height == 0.0 || occluder.id == point.own ? behind_nothing : vec4(side * occluder.plane_hi.xyz, beyond);
  return cone;
}

// At least 0 where the occluder stands between the point and a diode at `d`.
float depth_in(Cone cone, vec3 d) {
  return min(min(affine_at(cone.ab, d), affine_at(cone.bc, d)), min(affine_at(cone.ca, d), affine_at(cone.beyond, d)));
}

#endif
