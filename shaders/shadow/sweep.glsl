// Parts that the shaders of the sweep share: samples in the board's frame, and what may lie between a tile and the board.
#ifndef PMDSIM_SWEEP_GLSL
#define PMDSIM_SWEEP_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "shaders/shadow/sweep_interface.h"
#include "shaders/shadow/tiles.glsl"

layout(push_constant, std430) uniform Constants { SweepConstants constants; };
layout(constant_id = constant_lanes) const uint lanes = 8; // of a subgroup
layout(constant_id = constant_most_steps) const uint most_steps = most_sweep_steps;

// Texel buffers: lavapipe fetches the 16 bytes of a texel in a fourth of the time of as many words.
layout(set = 0, binding = 0) uniform usamplerBuffer item_texels; // four of each item
layout(set = 0, binding = 1) uniform samplerBuffer box_texels;   // low and high of each box
layout(set = 0, binding = 2) uniform usamplerBuffer rank_texels;
layout(set = 0, binding = 3) uniform usamplerBuffer prefix_texels;
layout(set = 0, binding = 4) uniform usamplerBuffer line_texels;
layout(set = 0, binding = 5) uniform samplerBuffer diode_texels; // two of each diode: x, y, their rests; z, its rest

layout(set = 0, binding = 6) uniform usamplerBuffer hidden_texels; // as item_texels, of triangles that the lens does not see

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Boards { SweepBoard at; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Shafts { TileShaft at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer SweepLists {
  SweepWork at;
  uint list[]; // of each tile the length, then the first entry; active tiles; samples to decide exactly
};

const float diagonal = 0.70710678;
// Rounding of what lies on a shaft's side, m.
const float shaft_slack_m = 1e-5;

uint lane() { return gl_SubgroupInvocationID; }
uint lanes_below() { return (1u << lane()) - 1u; }

Real3 in_board_frame(Real3 p, SweepBoard board) {
  Real3 at;
  at.x = add(dot3(real3(board.rows_hi[0].xyz, board.rows_lo[0].xyz), p), real(board.rows_hi[0].w, board.rows_lo[0].w));
  at.y = add(dot3(real3(board.rows_hi[1].xyz, board.rows_lo[1].xyz), p), real(board.rows_hi[1].w, board.rows_lo[1].w));
  at.z = add(dot3(real3(board.rows_hi[2].xyz, board.rows_lo[2].xyz), p), real(board.rows_hi[2].w, board.rows_lo[2].w));
  return at;
}

// Where the sample lies, camera frame; the lens itself where it sees nothing.
Real3 point_of(TileSample at, SweepBoard board) {
  return point_of(at, constants.strip, constants.position, constants.ids, board.slope, board.chip);
}

// The shape that it sees.
uint shape_seen(TileSample at) { return shape_of(at, constants.strip, constants.ids); }

// The normal of the shape that a sample lies on, turned to the lens.
vec3 normal_in_board_frame(uint id, SweepBoard board) {
  vec3 normal = load_vec4(constants.planes, 3 * id).xyz;
  return vec3(dot(board.rows_hi[0].xyz, normal), dot(board.rows_hi[1].xyz, normal), dot(board.rows_hi[2].xyz, normal));
}

// The supports of a set of points along the eight directions.
vec4 along_axes(vec2 p) { return vec4(p.x, -p.x, p.y, -p.y); }
vec4 along_diagonals(vec2 p) {
  float u = diagonal * (p.x + p.y), v = diagonal * (p.x - p.y);
  return vec4(u, -u, v, -v);
}

// Slopes k of the half-spaces u . xy + k z <= s that hold the ways from a sample at p to the board.
void slopes_of(vec3 p, SweepBoard board, out vec4 a, out vec4 b) {
  float inverse_depth = 1.0 / max(-p.z, 1e-6);
  a = (along_axes(p.xy) - board.supports_a) * inverse_depth;
  b = (along_diagonals(p.xy) - board.supports_b) * inverse_depth;
}

// The bounds that all the ways from some samples keep within.
struct Ways {
  vec4 slopes_a, slopes_b;
  vec4 supports_a, supports_b;
  vec3 centre, half_size; // box of the samples
  float farthest, highest; // z
};

Ways ways_of(vec4 slopes_a, vec4 slopes_b, vec3 low, vec3 high, SweepBoard board) {
  Ways ways;
  ways.slopes_a = slopes_a + shaft_slack_m;
  ways.slopes_b = slopes_b + shaft_slack_m;
  // Diodes and lens may stand before the board or behind it.
  ways.supports_a = max(board.supports_a + max(ways.slopes_a * board.diodes_low, ways.slopes_a * board.diodes_high),
                        ways.slopes_a * board.lens_z) + shaft_slack_m;
  ways.supports_b = max(board.supports_b + max(ways.slopes_b * board.diodes_low, ways.slopes_b * board.diodes_high),
                        ways.slopes_b * board.lens_z) + shaft_slack_m;
  ways.centre = 0.5 * (low + high);
  ways.half_size = max(0.5 * (high - low), vec3(0.0)) + 1e-6 * (abs(low) + abs(high)) + shaft_slack_m;
  ways.farthest = low.z - shaft_slack_m;
  ways.highest = board.highest + shaft_slack_m;
  return ways;
}

// The same where nothing can be left out.
Ways ways_anywhere(vec3 low, vec3 high, SweepBoard board) {
  Ways ways = ways_of(vec4(0.0), vec4(0.0), low, high, board);
  ways.supports_a = ways.supports_b = vec4(1e30);
  ways.farthest = -1e30;
  ways.highest = 1e30;
  return ways;
}

// Whether a sample is in front of the board, so that slopes from there are of use.
bool is_in_front(vec3 p, SweepBoard board) { return p.z < board.nearest; }

// How far the part of a box between two heights lies outside of the half-spaces u . xy + k z <= s, at least.
float outside_of(vec3 low, vec3 high, float z_low, float z_high, vec4 slopes_a, vec4 slopes_b, vec4 supports_a, vec4 supports_b) {
  vec4 a = vec4(low.x, -high.x, low.y, -high.y) + min(slopes_a * z_low, slopes_a * z_high) - supports_a;
  vec4 b = diagonal * vec4(low.x + low.y, -high.x - high.y, low.x - high.y, low.y - high.x) +
           min(slopes_b * z_low, slopes_b * z_high) - supports_b;
  vec4 outside = max(a, b);
  return max(max(outside.x, outside.y), max(outside.z, outside.w));
}

bool may_meet_box(Ways ways, vec3 low, vec3 high) {
  bool between = high.z > ways.farthest && low.z < ways.highest;
  return between && outside_of(low, high, max(low.z, ways.farthest), min(high.z, ways.highest), ways.slopes_a, ways.slopes_b,
                               ways.supports_a, ways.supports_b) < 0.0;
}

// An item's texels: ends a and b, the triangles t1 and t2 of an edge, their unit normals; packed rests of the ends.
struct Item {
  uvec4 a, b, first, second;
};

Item load_from(usamplerBuffer texels, uint i) {
  int at = int(4 * i);
  return Item(texelFetch(texels, at), texelFetch(texels, at + 1), texelFetch(texels, at + 2), texelFetch(texels, at + 3));
}
Item load_item(uint i) { return load_from(item_texels, i); }
Item load_hidden(uint i) { return load_from(hidden_texels, i); }

Real3 diode_place(int d) {
  vec4 across = texelFetch(diode_texels, 2 * d), along = texelFetch(diode_texels, 2 * d + 1);
  return Real3(real(across.x, across.z), real(across.y, across.w), real(along.x, along.y));
}

vec3 floats(uvec4 texel) { return uintBitsToFloat(texel.xyz); }
// The part that rounding to float took of an end: three numbers of ten bits.
vec3 rest_of(uint packed, float rest_step) {
  ivec3 parts = ivec3(bitfieldExtract(int(packed), 0, 10), bitfieldExtract(int(packed), 10, 10), bitfieldExtract(int(packed), 20, 10));
  return rest_step * vec3(parts);
}

// Whether an edge may change what is seen from one of the samples.
bool may_matter(Ways ways, Item item) {
  vec3 a = floats(item.a), b = floats(item.b);
  bool between = max(a.z, b.z) > ways.farthest && min(a.z, b.z) < ways.highest;
  vec4 outside_a = min(along_axes(a.xy) + ways.slopes_a * a.z, along_axes(b.xy) + ways.slopes_a * b.z) - ways.supports_a;
  vec4 outside_b = min(along_diagonals(a.xy) + ways.slopes_b * a.z, along_diagonals(b.xy) + ways.slopes_b * b.z) - ways.supports_b;
  vec4 outside = max(outside_a, outside_b);
  bool meets = between && max(max(outside.x, outside.y), max(outside.z, outside.w)) < 0.0;
  vec3 n1 = floats(item.first), n2 = floats(item.second), from = a - ways.centre;
  float h1 = dot(n1, from), h2 = dot(n2, from), r1 = dot(abs(n1), ways.half_size), r2 = dot(abs(n2), ways.half_size);
  bool no_silhouette = (h1 > r1 && h2 > r2) || (h1 < -r1 && h2 < -r2);
  return meets && !no_silhouette;
}

// The ways from samples to the lens alone.
struct Sights {
  vec4 slopes_a, slopes_b;
  vec3 low, high; // box of the samples
  float lens_z;
  float anywhere; // added to the sides where nothing can be left out
};

Sights sights_of(vec4 slopes_a, vec4 slopes_b, vec3 low, vec3 high, float lens_z) {
  vec3 slack = 1e-6 * (abs(low) + abs(high)) + shaft_slack_m;
  return Sights(slopes_a + shaft_slack_m, slopes_b + shaft_slack_m, low - slack, high + slack, lens_z, 0.0);
}

bool may_cross(Sights sights, vec3 low, vec3 high) {
  float z_low = max(low.z, sights.low.z) - sights.lens_z, z_high = min(high.z, sights.lens_z) - sights.lens_z;
  bool between = high.z > sights.low.z && low.z < sights.lens_z;
  return (between || sights.anywhere > 0.0) &&
         outside_of(low, high, z_low, z_high, sights.slopes_a, sights.slopes_b, vec4(0.0), vec4(0.0)) < shaft_slack_m + sights.anywhere;
}

// Whether a hidden triangle may lie between lens and samples: it turns its back to the lens, so a sample must be in front of it.
bool may_hide(Sights sights, Item item) {
  vec3 a = floats(item.a), b = floats(item.b), c = floats(item.first);
  vec3 normal = cross(b - a, c - a), centre = 0.5 * (sights.low + sights.high);
  float height = dot(normal, centre - a), reach = dot(abs(normal), 0.5 * (sights.high - sights.low) + 1e-6 * abs(a) + shaft_slack_m);
  return height + reach > 0.0 && may_cross(sights, min(min(a, b), c), max(max(a, b), c));
}

// The tiles in an order in which neighbours in the frame belong to different halves of the dispatch: lavapipe gives each thread a
// run of workgroups.
uint interleaved(uint i, uint count) {
  uint half_count = (count + 1u) / 2u;
  return i < half_count ? 2u * i : 2u * (i - half_count) + 1u;
}

// Where lengths, places, active tiles and samples are in the lists; `kind`: list_edges or list_hidden.
const uint list_edges = 0u, list_hidden = 1u;
uint length_at(uint kind, uint tile) { return 2u * kind * constants.tiles + tile; }
uint place_at(uint kind, uint tile) { return (1u + 2u * kind) * constants.tiles + tile; }
uint active_at(uint round_, uint entry) { return (4u + round_) * constants.tiles + entry; }
uint sample_at(uint entry) { return (4u + sweep_rounds) * constants.tiles + entry; }

uint round_of(uint place) { return min(place / entries_per_round, sweep_rounds); }

// Where a tile's list begins in the entries of this round.
uint list_begin(SweepLists lists, uint kind, uint tile) {
  return lists.list[place_at(kind, tile)] - constants.round * entries_per_round;
}

#endif
