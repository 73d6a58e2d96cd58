#version 460
// How many workgroups the passes after the uniform-pixel pass take for each list.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/pixel_list.glsl"

layout(local_size_x = 1) in;
layout(push_constant, std430) uniform Constants { PixelListConstants constants; };

// By one invocation: where each of several takes an address of its own from the constants, lavapipe reads for all of them what the
// first one's address holds.
void main() {
  [[unroll]] for (uint i = 0; i < pixel_lists; ++i) {
    PixelLists list = PixelLists(constants.lists[i]);
    uint groups = padded_count(list) / workgroup_size;
    list.head.pixel_groups_x = groups;
    list.head.sample_groups_x = groups * constants.samples;
  }
}
