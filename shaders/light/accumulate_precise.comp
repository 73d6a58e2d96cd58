#version 460
// accumulate.comp with all that a diode adds in Real: position, lengths, weights, moments and phases. For errors below
// float32's, and for returns that cancel.
#extension GL_GOOGLE_include_directive : require
#include "shaders/light/precise_sum.glsl"

layout(constant_id = constant_moments) const uint moments = 4;
layout(constant_id = constant_tones) const uint tones = 1;

void add_block(inout Real total[moments], PrecisePoint point, PreciseDiodes diodes, uint block, uint reached) {
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d) {
    WeightAndDifference we = weight_and_difference(point, diodes.at[block * diodes_per_block + d], (reached & 1u << d) != 0u);
    Real term = we.weight;
    total[0] = add(total[0], term);
    [[unroll]] for (uint k = 1; k < moments; ++k) {
      term = multiply(term, we.difference);
      total[k] = add(total[k], term);
    }
  }
}

// sum_k (j kappa)^k / k! * total[k], by Horner's rule.
RealComplex return_of(Real total[moments], Tone tone) {
  Real kappa = multiply(real(6.28318548, -1.74845553e-7), real(tone.turns_per_m.x, tone.turns_per_m.y));
  RealComplex z = RealComplex(real(0.0), real(0.0));
  [[unroll]] for (uint down = 0; down < moments; ++down) {
    uint k = moments - 1 - down;
    Real factor = divide(kappa, real(float(k + 1)));
    z = RealComplex(add(total[k], negate(multiply(z.im, factor))), multiply(z.re, factor));
  }
  return z;
}

void add_tone(uint t, uint i, Real total[moments], Real detour, LightRun run, float backscatter) {
  Tone tone = Tones(constants.tones).at[t];
  RealComplex turned = real_unit_phasor(real_turn_fraction(phase_turns(detour, run, tone)));
  add_to_plane(t, i, light_of_tone(run, tone) * backscatter, complex_multiply(return_of(total, tone), turned));
}

void main() {
  uint i = sample_of_invocation();
  LightRun run = LightRuns(constants.run).at;
  PrecisePoint point;
  ReferencePath path = load_point(i, run, point);
  Real total[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] = real(0.0);
  PreciseDiodes diodes = PreciseDiodes(constants.diodes);
  if (straight != 0) {
    [[unroll]] for (uint block = 0; block < blocks_per_run; ++block)
      add_block(total, point, diodes, block, visibility_of_block(i, block));
  } else {
    for (uint block = 0; block < constants.blocks; ++block)
      add_block(total, point, diodes, block, visibility_of_block(i, block));
  }

  Real detour = add(path.rho, negate(path.range));
  float backscatter = load_backscatter(i);
  add_terms(i, backscatter, terms_of(high(total[0]), high(point.rho), high(point.height), run));
  for (uint t = 0; t < tones; ++t)
    add_tone(t, i, total, detour, run, backscatter);
}
