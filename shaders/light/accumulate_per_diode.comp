#version 460
// The sum over the diodes of one group, for every sample, diode by diode: for square light, whose harmonics never end, which
// moments cannot serve. With rho = |P - G| and e = r_nm - rho each diode adds w_m C(phase of (rho + r_n) + kappa e) to
// each tap; kappa |e| is at most 1/2 (source_groups.cpp), so no phase has to be wrapped inside the loop.
#extension GL_GOOGLE_include_directive : require
#include "shaders/light/accumulate.glsl"
#include "shaders/light/taps.glsl"

// The reference path's phase less the tap's, in turns, in [-1/2, 1/2].
void find_tap_phases(ReferencePath path, LightRun run, Tone tone, out float phases[distinct_taps]) {
  Real turns = phase_turns(add(path.rho, path.range), run, tone);
  [[unroll]] for (uint k = 0; k < distinct_taps; ++k)
    phases[k] = turn_fraction(add(turns, negate(divide(real(float(k)), real(float(taps))))));
}

// (C + 1) / 4 of x in [-1, 1] turns.
float quarter_wave(float turns) { return abs(abs(turns) - 0.5); }

// The differences summed are small, and so is their rounding; the larger part has the same sum of weights in every tap, whose
// rounding turns nothing.
void add_diode(inout float part[totals], float phases[distinct_taps], vec2 weight_difference, Tone tone) {
  float difference_turns = weight_difference.y * tone.turns_per_m.x;
  [[unroll]] for (uint k = 0; k < distinct_taps; ++k)
    part[k] += weight_difference.x * (quarter_wave(phases[k] + difference_turns) - quarter_wave(phases[k]));
  part[distinct_taps] += weight_difference.x;
}

void add_block(inout float total[totals], Point point, float phases[distinct_taps], Tone tone,
               Diodes diodes, uint block, uint reached) {
  float part[totals];
  [[unroll]] for (uint k = 0; k < totals; ++k)
    part[k] = 0.0;
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d)
    add_diode(part, phases,
              weight_and_difference(point, diodes.at[block * diodes_per_block + d], (reached & 1u << d) != 0u), tone);
  [[unroll]] for (uint k = 0; k < totals; ++k)
    total[k] += part[k];
}

void add_taps(uint i, float total[totals], float phases[distinct_taps], float backscatter) {
  float weight = total[distinct_taps];
  [[unroll]] for (uint p = 0; p < tap_planes; ++p) {
    uint second = min(2 * p + 1, distinct_taps - 1); // the last of an odd number is there twice
    vec2 of_reference = 4.0 * vec2(quarter_wave(phases[2 * p]), quarter_wave(phases[second])) - 1.0;
    add_to_plane(p, i, backscatter, of_reference * weight + 4.0 * vec2(total[2 * p], total[second]));
  }
}

void main() {
  uint i = sample_of_invocation();
  LightRun run = LightRuns(constants.run).at;
  Point point;
  ReferencePath path = load_point(i, run, point);
  Tone tone = Tones(constants.tones).at[0];
  float phases[distinct_taps];
  find_tap_phases(path, run, tone, phases);
  float total[totals];
  [[unroll]] for (uint k = 0; k < totals; ++k)
    total[k] = 0.0;
  Diodes diodes = Diodes(constants.diodes);
  if (straight != 0) {
    [[unroll]] for (uint block = 0; block < blocks_per_run; ++block)
      add_block(total, point, phases, tone, diodes, block, visibility_of_block(i, block));
  } else {
    for (uint block = 0; block < constants.blocks; ++block)
      add_block(total, point, phases, tone, diodes, block, visibility_of_block(i, block));
  }

  float backscatter = load_backscatter(i);
  add_terms(i, backscatter, terms_of(total[distinct_taps], point.rho, point.height, run));
  add_taps(i, total, phases, light_of_tone(run, tone) * backscatter);
}
