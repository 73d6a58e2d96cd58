#version 460
// Tags a visible fragment with its pixel ID and its triangle ID; the depth test keeps the nearest.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(push_constant, std430) uniform Constants { VisibilityConstants constants; };
layout(location = 0) flat in uint visible_triangle;
layout(location = 0) out uvec2 tag;

void main() {
  uint side = constants.fragments_per_pixel_side;
  uvec2 in_tile = uvec2(gl_FragCoord.xy) - uvec2(constants.tile_x, constants.tile_y);
  uvec2 pixel = uvec2(constants.column, constants.row) + in_tile / max(side, 1u);
  tag = uvec2(side == 0u ? 1u : pixel.y * constants.resolution_x + pixel.x + 1u, visible_triangle);
}
