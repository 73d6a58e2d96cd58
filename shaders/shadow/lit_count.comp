#version 460
// Counts the diodes of a window that reach each sample.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/buffers.glsl"
#include "shaders/shared/constants.h"
#include "shaders/shadow/lit_interface.h"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { LitCountConstants constants; };
layout(constant_id = constant_bundles) const uint bundles = bundles_per_window;
layout(constant_id = constant_is_first) const uint is_first = 0;

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint count = 0u;
  [[unroll]] for (uint bundle = 0; bundle < bundles; ++bundle)
    count += bitCount(Words(constants.visibility).at[bundle * constants.plane + i] & Words(constants.diodes).at[bundle]);
  Words lit = Words(constants.lit);
  lit.at[i] = is_first != 0 ? count : lit.at[i] + count;
}
