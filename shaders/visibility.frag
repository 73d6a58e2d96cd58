#version 460
// Tags a visible sample with its pixel ID and its triangle ID; the depth test keeps the nearest.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(push_constant, std430) uniform Constants { VisibilityConstants constants; };
layout(location = 0) flat in uint visible_triangle;
layout(location = 0) out uvec2 tag;

void main() {
  Strip strip = constants.strip;
  uvec2 pixel = uvec2(strip.column, strip.row) + uvec2(gl_FragCoord.xy) / strip.samples;
  tag = uvec2(pixel.y * strip.resolution_x + pixel.x + 1u, visible_triangle);
}
