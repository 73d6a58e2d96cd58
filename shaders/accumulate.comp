#version 460
// The sum over the diodes of one group, for every sample (DESIGN: "Two ways to the sum", by moments). With the group's
// reference point G, rho = |P - G| and e = r_nm - rho, the return is
//   exp(j 2 pi (rho + r_n) / lambda) * sum_k (j kappa)^k / k! * sum_m w_m e_m^k,    kappa = 2 pi f / c,
// so the loop over the diodes holds no sine and no long path: float32 is enough for it at any range.
// STRAIGHT_LINE: one dispatch is one unrolled run of constant_blocks blocks, without a branch, so that lavapipe reads
// the diodes once for all lanes; else a loop over the blocks, which suits GPUs.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "accumulate.glsl"

layout(constant_id = constant_moments) const uint moments = 4;
layout(constant_id = constant_tones) const uint tones = 1;

void add_block(inout float total[moments], Point point, Diodes diodes, uint block, uint reached) {
  float part[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    part[k] = 0.0;
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d) {
    vec2 we = weight_and_excess(point, diodes.at[block * diodes_per_block + d], (reached & 1u << d) != 0u);
    float term = we.x;
    part[0] += term;
    [[unroll]] for (uint k = 1; k < moments; ++k) {
      term *= we.y;
      part[k] += term;
    }
  }
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] += part[k];
}

// sum_k (j kappa)^k / k! * total[k], by Horner's rule.
vec2 return_of(float total[moments], float kappa) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint down = 0; down < moments; ++down) {
    uint k = moments - 1 - down;
    z = vec2(total[k], 0.0) + vec2(-z.y, z.x) * (kappa / float(k + 1));
  }
  return z;
}

// Samples are summed relative to twice their own range, which the resolve pass turns back. `detour` is how much longer the way
// over the reference point is than that.
void add_tone(uint t, uint i, float total[moments], Real detour, float backscatter) {
  Tone tone = Tones(constants.tones).at[t];
  float turns = turn_fraction(phase_turns(detour, tone));
  add_to_plane(t, i, backscatter, complex_multiply(return_of(total, tone.wavenumber), unit_phasor(turns)));
}

// More of them would take long to compile, and are seldom.
const uint unrolled_tones = 16;

void main() {
  uint i = gl_GlobalInvocationID.x;
  Point point;
  ReferencePath path = load_point(i, point);
  float total[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] = 0.0;
  Diodes diodes = Diodes(constants.diodes);
#ifdef STRAIGHT_LINE
  [[unroll]] for (uint block = 0; block < unrolled_blocks; ++block)
    add_block(total, point, diodes, block, reached_of_block(i, block));
#else
  for (uint block = 0; block < constants.blocks; ++block)
    add_block(total, point, diodes, block, reached_of_block(i, block));
#endif

  Real detour = add(path.rho, negate(path.range));
  float backscatter = Floats(constants.backscatter).at[i];
  if (tones <= unrolled_tones) {
    [[unroll]] for (uint t = 0; t < tones; ++t)
      add_tone(t, i, total, detour, backscatter);
  } else {
    for (uint t = 0; t < tones; ++t)
      add_tone(t, i, total, detour, backscatter);
  }
}
