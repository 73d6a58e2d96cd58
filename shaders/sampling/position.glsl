// The points of samples, camera frame, m: Real[3] each.
#ifndef PMDSIM_POSITION_GLSL
#define PMDSIM_POSITION_GLSL

#include "shaders/shared/interface.h"
#include "shaders/shared/real.glsl"

layout(buffer_reference, std430, buffer_reference_align = 8) buffer Reals { Real at[]; };

Real3 load_position(uvec2 address, uint i) {
  Reals from = Reals(address);
  return Real3(from.at[3 * i], from.at[3 * i + 1], from.at[3 * i + 2]);
}
void store_position(uvec2 address, uint i, Real3 value) {
  Reals to = Reals(address);
  to.at[3 * i] = value.x;
  to.at[3 * i + 1] = value.y;
  to.at[3 * i + 2] = value.z;
}

#endif
