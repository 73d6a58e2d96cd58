// A run's sum by moments (DESIGN: "Two ways to the sum"). With the group's reference point G, rho = |P - G| and e = r_nm -
// rho, the return is
//   exp(j 2 pi (rho + r_n) / lambda) * sum_k (j kappa)^k / k! * sum_m w_m e_m^k,    kappa = 2 pi f / c,
// so the loop over the diodes holds no sine and no long path: float32 is enough for it at any range.
#ifndef PMDSIM_MOMENTS_GLSL
#define PMDSIM_MOMENTS_GLSL

#include "sum.glsl"

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

// The return relative to twice the sample's own range, which the resolve pass turns back. The way over the reference point is
// longer than that by rho - range.
vec2 tone_return(float total[moments], ReferencePath path, LightRun run, Tone tone) {
  Real detour = add(path.rho, negate(path.range));
  return complex_multiply(return_of(total, tone.wavenumber), unit_phasor(turn_fraction(phase_turns(detour, run, tone))));
}

#endif
