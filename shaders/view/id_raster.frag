#version 460
// Tags a visible fragment with its pixel ID and its triangle ID; the depth test, or its key, keeps the nearest.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#ifdef TAG_KEYS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "shaders/view/tag.glsl"

layout(push_constant, std430) uniform Constants { VisibilityConstants constants; };
layout(location = 0) flat in uint visible_triangle;

void main() { leave_tag(constants, uvec2(gl_FragCoord.xy), visible_triangle); }
