// How much the surfaces at an edge add to the count of those between, by the side of each that shows to the sample.
#ifndef PMDSIM_SWEEP_WEIGHT_GLSL
#define PMDSIM_SWEEP_WEIGHT_GLSL

#include "shaders/shadow/sweep.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer ExactPlanes { SweepPlanes at[]; };

const float own_rounding = 2.3e-13; // as in occlusion.glsl: a pair of floats holds 48 bits

// -1, 0 or 1: on which side of a triangle's plane the sample lies, if its own rounding leaves a side, in Real.
int exact_side(vec4 plane_hi, vec4 plane_lo, Real3 p, SweepBoard board) {
  float rounding = own_rounding * (dot(abs(high3(p)), vec3(1.0)) + abs(plane_hi.w)) + board.world_rounding;
  Real height = add(dot3(real3(plane_hi.xyz, plane_lo.xyz), p), negate(real(plane_hi.w, plane_lo.w)));
  float rounded = high(height);
  return abs(rounded) <= rounding ? 0 : rounded > 0.0 ? 1 : -1;
}

// The weight that a triangle adds to its edges: its side as seen from the sample, but 0 where board and sample are on one side,
// so that it can never be between. `board_side`: 1 or 2 where all of the board is in front of it or behind.
int weight_of(int side, uint board_side) {
  return side == 0 || (side > 0 && board_side == 1u) || (side < 0 && board_side == 2u) ? 0 : side;
}

// The weight of an edge that has to be decided exactly.
int exact_weight(uint index, uint sides_1, uint sides_2, bool is_boundary, Real3 p, SweepBoard board) {
  SweepPlanes planes = ExactPlanes(constants.exact).at[index];
  int first = weight_of(exact_side(planes.first_hi, planes.first_lo, p, board), sides_1);
  int second = weight_of(exact_side(planes.second_hi, planes.second_lo, p, board), sides_2);
  return is_boundary ? -first : second - first;
}

// Whether a triangle whose back the lens would see may lie between it and the sample; all places relative to the sample, in float.
bool may_hide(vec3 a, vec3 b, vec3 c, vec3 to_lens) {
  float ab = dot(cross(a, b), to_lens), bc = dot(cross(b, c), to_lens), ca = dot(cross(c, a), to_lens);
  float size_a = dot(abs(a), vec3(1.0)), size_b = dot(abs(b), vec3(1.0)), size_c = dot(abs(c), vec3(1.0));
  float slack = 1e-6 * dot(abs(to_lens), vec3(1.0)) * max(size_a * size_b, max(size_b * size_c, size_c * size_a));
  bool inside = (ab > -slack && bc > -slack && ca > -slack) || (ab < slack && bc < slack && ca < slack);
  vec3 normal = cross(b - a, c - a);
  return inside && dot(normal, a) < 1e-6 * dot(abs(normal), abs(a)); // the sample has to be in front
}

#endif
