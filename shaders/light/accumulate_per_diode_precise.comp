#version 460
// accumulate_per_diode.comp with all that a diode adds in Real, the phases and the taps too.
#extension GL_GOOGLE_include_directive : require
#include "shaders/light/precise_sum.glsl"
#include "shaders/light/taps.glsl"

// The reference path's phase less the tap's, in turns, in [-1/2, 1/2].
void find_tap_phases(ReferencePath path, LightRun run, Tone tone, out Real phases[distinct_taps]) {
  Real turns = phase_turns(add(path.rho, path.range), run, tone);
  [[unroll]] for (uint k = 0; k < distinct_taps; ++k)
    phases[k] = real_turn_fraction(add(turns, negate(divide(real(float(k)), real(float(taps))))));
}

Real size_of(Real x) { return high(x) < 0.0 ? negate(x) : x; }

// (C + 1) / 4 of x in [-1, 1] turns.
Real quarter_wave(Real turns) { return size_of(add(size_of(turns), real(-0.5))); }

void add_diode(inout Real total[totals], Real phases[distinct_taps], WeightAndDifference diode, Real turns_per_m) {
  Real difference_turns = multiply(diode.difference, turns_per_m);
  [[unroll]] for (uint k = 0; k < distinct_taps; ++k) {
    Real apart = add(quarter_wave(add(phases[k], difference_turns)), negate(quarter_wave(phases[k])));
    total[k] = add(total[k], multiply(diode.weight, apart));
  }
  total[distinct_taps] = add(total[distinct_taps], diode.weight);
}

void add_block(inout Real total[totals], PrecisePoint point, Real phases[distinct_taps], Real turns_per_m, PreciseDiodes diodes,
               uint block, uint reached) {
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d)
    add_diode(total, phases,
              weight_and_difference(point, diodes.at[block * diodes_per_block + d], (reached & 1u << d) != 0u), turns_per_m);
}

Real tap_of(Real total[totals], Real phases[distinct_taps], uint k) {
  Real of_reference = add(multiply(real(4.0), quarter_wave(phases[k])), real(-1.0));
  return add(multiply(of_reference, total[distinct_taps]), multiply(real(4.0), total[k]));
}

void main() {
  uint i = sample_of_invocation();
  LightRun run = LightRuns(constants.run).at;
  PrecisePoint point;
  ReferencePath path = load_point(i, run, point);
  Tone tone = Tones(constants.tones).at[0];
  Real phases[distinct_taps];
  find_tap_phases(path, run, tone, phases);
  Real total[totals];
  [[unroll]] for (uint k = 0; k < totals; ++k)
    total[k] = real(0.0);
  Real turns_per_m = real(tone.turns_per_m.x, tone.turns_per_m.y);
  PreciseDiodes diodes = PreciseDiodes(constants.diodes);
  if (straight != 0) {
    [[unroll]] for (uint block = 0; block < blocks_per_run; ++block)
      add_block(total, point, phases, turns_per_m, diodes, block, visibility_of_block(i, block));
  } else {
    for (uint block = 0; block < constants.blocks; ++block)
      add_block(total, point, phases, turns_per_m, diodes, block, visibility_of_block(i, block));
  }

  float backscatter = load_backscatter(i);
  add_terms(i, backscatter, terms_of(high(total[distinct_taps]), high(point.rho), high(point.height), run));
  backscatter *= light_of_tone(run, tone);
  [[unroll]] for (uint p = 0; p < tap_planes; ++p) {
    uint second = min(2 * p + 1, distinct_taps - 1); // of an odd number the last is there twice
    add_to_plane(p, i, backscatter, RealComplex(tap_of(total, phases, 2 * p), tap_of(total, phases, second)));
  }
}
