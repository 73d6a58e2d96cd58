#version 460
// Finds what the ways from each tile's samples to the board keep within. An invocation is a tile.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/sweep.glsl"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_all_facing) const uint all_facing = 0;

// Whether a diode may stand behind the surface that a sample lies on.
bool may_turn_away(TileSample at, vec3 p, SweepBoard board) {
  uint own = shape_seen(at);
  vec3 normal = normal_in_board_frame(own, board);
  float of_depths = min(normal.z * board.diodes_low, normal.z * board.diodes_high);
  float lowest = of_depths - dot(normal, p) - 1.00001 * board.radius * length(normal.xy);
  return lowest < 1e-6 * (length(p) + board.radius + max(abs(board.diodes_low), abs(board.diodes_high)));
}

void main() {
  uint tile = gl_GlobalInvocationID.x;
  SweepBoard board = Boards(constants.board).at;
  vec4 slopes_a = vec4(-1e9), slopes_b = vec4(-1e9), sights_a = vec4(-1e9), sights_b = vec4(-1e9);
  vec3 low = vec3(1e9), high = vec3(-1e9);
  bool turns_away = false, in_front = true;
  for (uint within = 0; within < tile_samples; ++within) {
    TileSample at = tile_sample(constants.strip, min(tile, constants.tiles - 1u), within);
    Real3 position = point_of(at, board);
    bool sees = at.is_there && high3(position) != vec3(0.0);
    vec3 p = high3(in_board_frame(position, board));
    vec4 a, b;
    slopes_of(p, board, a, b);
    slopes_a = sees ? max(slopes_a, a) : slopes_a;
    slopes_b = sees ? max(slopes_b, b) : slopes_b;
    in_front = in_front && (!sees || is_in_front(p, board));
    float inverse_depth = 1.0 / (board.lens_z - p.z);
    sights_a = sees ? max(sights_a, along_axes(p.xy) * inverse_depth) : sights_a;
    sights_b = sees ? max(sights_b, along_diagonals(p.xy) * inverse_depth) : sights_b;
    if (all_facing == 0)
      turns_away = turns_away || (sees && may_turn_away(at, p, board));
    low = sees ? min(low, p) : low;
    high = sees ? max(high, p) : high;
  }
  if (tile < constants.tiles)
    Shafts(constants.shafts).at[tile] = TileShaft(slopes_a, slopes_b, sights_a, sights_b, vec4(low, turns_away ? 1.0 : 0.0), vec4(high, in_front ? 0.0 : 1.0));
}
