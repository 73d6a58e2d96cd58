#version 460
// How many workgroups the passes after the short way take for each list.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "pixel_list.glsl"

layout(local_size_x = pixel_lists) in;
layout(push_constant, std430) uniform Constants { PixelListConstants constants; };

void main() {
  PixelLists list = PixelLists(constants.lists[gl_LocalInvocationID.x]);
  uint groups = padded_count(list) / workgroup_size;
  list.head.pixel_groups_x = groups;
  list.head.sample_groups_x = groups * constants.samples;
}
