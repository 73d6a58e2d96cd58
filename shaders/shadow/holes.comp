#version 460
// Takes from a sample the diodes whose light a triangle with holes or a disc keeps off. A workgroup is a subgroup: a sample of a tile
// that a range of these shapes concerns. Its invocations are boxes of shapes, then shapes, then bundles of diodes, then diodes.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "shaders/shadow/holes.glsl"
#include "shaders/shadow/occlusion.glsl"
#include "shaders/view/surface_appearance.glsl"

layout(local_size_x_id = constant_lanes) in;
layout(constant_id = constant_lanes) const uint lanes = 8;
layout(constant_id = constant_bundles) const uint bundles = bundles_per_window;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Bundles { BundleDiodes at[]; };

HolesWindow window;
LitPoint point;
// An invocation's bundle.
DiodeFrame frame;
vec3 extent;
uint open; // its diodes that shine and that nothing is known to keep off, a bit each

uint lane() { return gl_SubgroupInvocationID; }

Occluder load_shape(uint i) {
  int at = int(hole_texels * i);
  vec4 part[8];
  [[unroll]] for (int k = 0; k < 8; ++k)
    part[k] = uintBitsToFloat(texelFetch(shape_texels, at + k));
  uvec4 rest = texelFetch(shape_texels, at + 8);
  return Occluder(part[0], part[1], part[2], part[3], part[4], part[5], part[6], part[7], rest.x, rest.y, 0u, 0u);
}

// Whether some diode of the window may lie, seen from the sample, on the inner side of the edge from `a` to `b`: the largest value
// that edge_plane's function can take, det(a - P, b - a, D - a) up to its sign.
bool may_be_inside(vec3 a, vec3 b, float side) {
  vec3 edge = b - a, from = a - point.hi;
  vec3 half_size = 0.5 * (window.box.high.xyz - window.box.low.xyz), diodes = 0.5 * (window.box.low.xyz + window.box.high.xyz) - a;
  vec3 normal = cross(from, edge);
  float p = size_of(from), e = size_of(edge), d = size_of(diodes) + size_of(half_size);
  float corners = 2e-7 * (size_of(a) + size_of(b) + size_of(point.hi)); // rounded to float
  float rounding = 2e-6 * p * e * d + corners * (e * d + 2.0 * p * d + p * e);
  return side * dot(normal, diodes) + dot(abs(normal), half_size) + rounding >= 0.0;
}

// Whether the shape may stand between the sample and some diode of the window. It may say so too often, never too seldom.
bool may_block(Occluder shape, Shaft shaft) {
  vec3 a = shape.a_hi.xyz, b = shape.b_hi.xyz, c = shape.c_hi.xyz, normal = shape.plane_hi.xyz;
  vec3 rounding = 2e-7 * max(abs(a), max(abs(b), abs(c)));
  vec3 middle = 0.5 * (window.box.low.xyz + window.box.high.xyz), half_size = 0.5 * (window.box.high.xyz - window.box.low.xyz);
  float height = dot(normal, point.hi) - shape.plane_hi.w, of_diodes = dot(normal, middle) - shape.plane_hi.w;
  float slack = 1e-6 * (dot(abs(normal), abs(point.hi)) + abs(shape.plane_hi.w));
  float reach = dot(abs(normal), half_size) + 1e-6 * (dot(abs(normal), abs(middle) + half_size) + abs(shape.plane_hi.w));
  bool between = (height < slack && of_diodes > -reach) || (height > -slack && of_diodes < reach);
  float side = height < 0.0 ? 1.0 : -1.0;
  bool inside = abs(height) <= slack || (may_be_inside(a, b, side) && may_be_inside(b, c, side) && may_be_inside(c, a, side));
  return shape.id != point.own && between && inside &&
         may_meet(shaft, min(min(a, b), c) - rounding, max(max(a, b), c) + rounding);
}

// Whether an affine function of Cone may be at least 0 for a diode of the invocation's bundle.
bool may_be_inside(vec4 f) {
  float spread = dot(abs(f.xyz), extent);
  return f.w + spread + 1e-6 * (abs(f.w) + spread) >= 0.0;
}

// Where the way from the sample to a diode meets the shape.
Real3 meeting_point(Occluder shape, vec3 diode, vec3 centre) {
  Real3 from = real3(point.hi, point.lo), normal = real3(shape.plane_hi.xyz, shape.plane_lo.xyz);
  Real3 way = subtract3(add3(real3(diode, vec3(0.0)), real3(centre, vec3(0.0))), from);
  Real offset = real(shape.plane_hi.w, shape.plane_lo.w);
  return add3(from, scale3(way, divide(add(offset, negate(dot3(normal, from))), dot3(normal, way))));
}

vec3 place_of(uint bundle, uint d) { return texelFetch(place_texels, int(bundle * diodes_per_bundle + d)).xyz; }

// The bundle's diodes that the shape would keep off if it had no holes.
uint diodes_behind(uint bundle, Cone cone) {
  uint behind = 0u;
  for (uint first = 0; first < diodes_per_bundle; first += lanes)
    behind |= subgroupBallot(depth_in(cone, place_of(bundle, first + lane())) >= 0.0).x << first;
  return behind;
}

// Those of the diodes `behind` that it does keep off.
uint diodes_kept_off(uint bundle, uint behind, Occluder shape, vec3 centre) {
  ShapePaint paint = ShapePaints(window.paints).at[shape.id];
  SurfacePaint surface = SurfacePaints(window.surfaces).at[paint.surface];
  uint kept_off = 0u;
  for (uint first = 0; first < diodes_per_bundle; first += lanes) {
    uint d = first + lane();
    bool asked = (behind >> d & 1u) != 0u, is_there = false;
    while (subgroupAny(asked)) { // as a branch
      is_there = asked && look_of(paint, surface, meeting_point(shape, place_of(bundle, d), centre)).is_there;
      asked = false;
    }
    kept_off |= subgroupBallot(is_there).x << first;
  }
  return kept_off;
}

void try_shape(uint i) {
  Occluder shape = load_shape(i);
  Cone cone = cone_of(shape, point, frame, window.world_rounding);
  bool concerned = open != 0u && may_be_inside(cone.ab) && may_be_inside(cone.bc) && may_be_inside(cone.ca) && may_be_inside(cone.beyond);
  for (uint left = subgroupBallot(concerned).x; left != 0u; left &= left - 1u) {
    uint bundle = findLSB(left);
    Cone of_bundle = Cone(subgroupShuffle(cone.ab, bundle), subgroupShuffle(cone.bc, bundle), subgroupShuffle(cone.ca, bundle),
                          subgroupShuffle(cone.beyond, bundle));
    vec3 centre = subgroupShuffle(frame.centre, bundle);
    uint behind = diodes_behind(bundle, of_bundle) & subgroupShuffle(open, bundle);
    for (; behind != 0u; behind = 0u) { // as a branch: lavapipe takes both sides of one
      uint kept_off = diodes_kept_off(bundle, behind, shape, centre);
      open &= lane() == bundle ? ~kept_off : ~0u;
    }
  }
}

void try_range(uint range) {
  Shaft shaft = shaft_to_diodes(point.hi, point.hi, window);
  uint boxes = (window.shapes + hole_width - 1u) / hole_width, blocks = (boxes + hole_width - 1u) / hole_width;
  uint block = hole_blocks * range + lane();
  uint blocks_met = subgroupBallot(lane() < hole_blocks && block < blocks && meets_box(shaft, window.first_block + block)).x;
  for (; blocks_met != 0u; blocks_met &= blocks_met - 1u) {
    uint first_box = hole_width * (hole_blocks * range + findLSB(blocks_met)), box = first_box + lane();
    uint boxes_met = subgroupBallot(lane() < hole_width && box < boxes && meets_box(shaft, box)).x;
    for (; boxes_met != 0u; boxes_met &= boxes_met - 1u) {
      uint first_shape = hole_width * (first_box + findLSB(boxes_met)), i = first_shape + lane();
      bool may = lane() < hole_width && i < window.shapes && may_block(load_shape(min(i, window.shapes - 1u)), shaft);
      for (uint left = subgroupBallot(may).x; left != 0u; left &= left - 1u)
        try_shape(first_shape + findLSB(left));
    }
  }
}

void main() {
  HoleLists lists = HoleLists(constants.work);
  if (entry_of_workgroup() >= lists.at.ranges[constants.range].count)
    return;
  window = Windows(constants.window).at;
  uint tile = lists.list[tile_at(constants.range, entry_of_workgroup())];
  TileSample at = tile_sample(constants.strip, tile, gl_WorkGroupID.x);
  Real3 place = point_of(at, window);
  if (!at.is_there || high3(place) == vec3(0.0))
    return;
  point = LitPoint(high3(place), rest3(place), shape_of(at, constants.strip, constants.ids));
  uint bundle = min(lane(), bundles - 1u), word = bundle * constants.plane + at.i;
  vec4 centre = Bundles(window.bundles).at[bundle].centre;
  frame = DiodeFrame(centre.xyz, centre.w);
  extent = Bundles(window.bundles).at[bundle].extent.xyz;
  Words bits = Words(constants.visibility);
  uint shining = window.shining[bundle / 4u][bundle % 4u], before = lane() < bundles ? bits.at[word] & shining : 0u;
  open = before;
  if (!subgroupAny(open != 0u))
    return;
  try_range(constants.first_range + constants.range);
  uint kept_off = before & ~open, missing = subgroupAdd(bitCount(kept_off));
  if (kept_off != 0u)
    bits.at[word] &= ~kept_off;
  if (missing > 0u && lane() == 0u)
    Words(constants.lit).at[at.i] -= missing;
}
