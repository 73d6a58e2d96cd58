#version 460
// Philox of one counter and key in each invocation.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/philox.h"

layout(local_size_x = 1) in;
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Counters { uvec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Keys { uvec2 at[]; };
layout(push_constant, std430) uniform Constants {
  uvec2 counters; // in and out
  uvec2 keys;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  Counters(counters).at[i] = philox(Counters(counters).at[i], Keys(keys).at[i]);
}
