#version 460
// Finds the box around each tile's samples. An invocation is a tile.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/holes.glsl"

layout(local_size_x = workgroup_size) in;

void main() {
  uint tile = gl_GlobalInvocationID.x;
  HolesWindow window = Windows(constants.window).at;
  vec3 low = vec3(1e30), high = vec3(-1e30);
  for (uint within = 0; within < tile_samples; ++within) {
    TileSample at = tile_sample(constants.strip, min(tile, constants.tiles - 1u), within);
    vec3 p = high3(point_of(at, window));
    bool sees = at.is_there && p != vec3(0.0);
    low = sees ? min(low, p) : low;
    high = sees ? max(high, p) : high;
  }
  if (tile < constants.tiles)
    Boxes(constants.boxes).at[tile] = TileBox(vec4(low, 0.0), vec4(high, 0.0));
}
