#version 460
// Tags a visible fragment with its pixel ID and its triangle ID; the depth test keeps the nearest.
#extension GL_GOOGLE_include_directive : require
#include "tag.glsl"

layout(push_constant, std430) uniform Constants { VisibilityConstants constants; };
layout(location = 0) flat in uint visible_triangle;
layout(location = 0) out uvec2 tag;

void main() { tag = tag_of_fragment(constants, uvec2(gl_FragCoord.xy), visible_triangle); }
