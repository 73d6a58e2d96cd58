#version 460
// Cuts each tile's samples into a near and a far part and finds the box around the points of each.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { LitTilesConstants constants; };
layout(constant_id = constant_tiled) const uint tiled = 0;

const float infinity = 1.0 / 0.0, far_m = 1e37; // farther than anything

// Its point, or the lens where it sees nothing.
vec3 point_of(uint tile, uint within) {
  TileSample at = tile_sample(constants.strip, tile, within);
  vec3 point = high3(load_position(constants.position, at.i));
  return at.is_there ? point : vec3(0.0);
}

TilePart empty_part(float nearest_m, float farthest_m) {
  TilePart part;
  part.low = vec4(far_m);
  part.high = vec4(-far_m);
  part.nearest_m = nearest_m;
  part.farthest_m = farthest_m;
  part.own = 0u;
  part.body = no_body;
  return part;
}

void add_own(inout TilePart part, uint id) {
  bool known = false;
  [[unroll]] for (uint k = 0; k < own_shapes; ++k)
    known = known || (k < part.own && part.own_ids[k] == id);
  [[unroll]] for (uint k = 0; k < own_shapes; ++k)
    part.own_ids[k] = !known && k == part.own ? id : part.own_ids[k];
  part.own += known || part.own > own_shapes ? 0u : 1u;
}

void add_sample(inout TilePart part, vec3 point, uint id, uint body) {
  if (point == vec3(0.0) || point.z < part.nearest_m || point.z >= part.farthest_m)
    return;
  part.low.xyz = min(part.low.xyz, point);
  part.high.xyz = max(part.high.xyz, point);
  part.body = part.own == 0u || part.body == body ? body : no_body;
  add_own(part, id);
}

// Rounded to float, the points are off by half a unit in the last place.
void widen(inout TilePart part) {
  part.low.xyz -= 1.2e-7 * abs(part.low.xyz);
  part.high.xyz += 1.2e-7 * abs(part.high.xyz);
}

// Depths of a tile's samples, m; low > high where it sees nothing.
struct Depths {
  float low, high;
};

// Of those from `from_m` on and below `to_m`.
Depths depths_between(uint tile, float from_m, float to_m) {
  Depths depths = Depths(infinity, -infinity);
  for (uint within = 0; within < tile_samples; ++within) {
    vec3 point = point_of(tile, within);
    if (point != vec3(0.0) && point.z >= from_m && point.z < to_m)
      depths = Depths(min(depths.low, point.z), max(depths.high, point.z));
  }
  return depths;
}

// Where the far part begins, m: at the middle of the depths, if there is a wide gap.
float far_from_m(uint tile) {
  Depths all = depths_between(tile, -infinity, infinity);
  float middle_m = 0.5 * (all.low + all.high);
  float gap_m = depths_between(tile, middle_m, infinity).low - depths_between(tile, -infinity, middle_m).high;
  return gap_m > 0.5 * (all.high - all.low) ? middle_m : infinity;
}

void main() {
  Strip strip = constants.strip;
  uint tile = gl_GlobalInvocationID.x;
  uvec2 tiles = tiles_of(strip);
  if (tile >= tiles.x * tiles.y * strip.samples * strip.samples)
    return;
  float middle_m = far_from_m(tile);
  TilePart near = empty_part(-infinity, middle_m), far = empty_part(middle_m, infinity);
  for (uint within = 0; within < tile_samples; ++within) {
    TileSample at = tile_sample(strip, tile, within);
    vec3 point = point_of(tile, within);
    uint id = point != vec3(0.0) ? shape_of(at, strip, constants.ids, tiled != 0) : 0u;
    uint body = body_of(constants.scene, id);
    add_sample(near, point, id, body);
    add_sample(far, point, id, body);
  }
  widen(near);
  widen(far);
  Parts parts = Parts(constants.parts);
  parts.at[parts_per_tile * tile] = near;
  parts.at[parts_per_tile * tile + 1u] = far;
}
