// Phase, amplitude, distance, taps and ground truth of a pixel from the sums of its samples, of one modulation frequency.
#ifndef PMDSIM_DEMODULATION_GLSL
#define PMDSIM_DEMODULATION_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/compensated.glsl"
#include "shaders/shared/elementary.glsl"
#include "shaders/shared/mean.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/real_elementary.glsl"
#include "shaders/shared/constants.h"
#include "shaders/signal/violations.glsl"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_planes) const uint planes = 1;
layout(constant_id = constant_waveform) const uint waveform = waveform_sine;
layout(constant_id = constant_taps) const uint taps = 4;
layout(constant_id = constant_keep_taps) const uint keep_taps = 0;
layout(constant_id = constant_ground_truth) const uint ground_truth = 1;
layout(constant_id = constant_tiled) const uint tiled = 0;
layout(constant_id = constant_lit_is_kept) const uint lit_is_kept = 0;
layout(constant_id = constant_keeps_terms) const uint keeps_terms = 0;
layout(constant_id = constant_keeps_bounds) const uint keeps_bounds = 0;
layout(constant_id = constant_keeps_rests) const uint keeps_rests = 0;
layout(constant_id = constant_precise_sum) const uint precise_sum = 0;

// The slots of engine/model/channels.h: of the ground truth (which the host may find in records instead, but for the range), and
// of each frequency. Channels 2 n and 2 n + 1 lie side by side, a word of each for every pixel: lavapipe stores lane by lane, two
// words as fast as one.
const uint channel_coverage = 0;
const uint channel_z_m = 1;
const uint channel_triangle_id = 2;
const uint channel_object_id = 3;
const uint channel_amplitude = 0;
const uint channel_phase_rad = 1;
const uint channel_distance_m = 2;
const uint channel_range_m = 3; // the same of each frequency: it fills a pair
const uint channel_tap = 4;     // the first
const uint bound_channel = channel_tap + (keep_taps != 0 ? (taps + 1) / 2 * 2 : 0); // in a pair of its own
const uint rest_channels = bound_channel + (keeps_bounds != 0 ? 2 : 0); // a pair: of distance and range

float nan() { return uintBitsToFloat(0x7fc00000u); }

struct PixelSum {
  vec4 z[planes]; // compensated; of a tone relative to twice the reference range
  vec3 terms;     // sum of |terms| over the samples, of their weights' own errors, and of |terms| times the squares of weights' errors
                  // within beams; where an error was asked for
  Real range;     // sum over the hits, m
  Real depth;
  Real reference_m; // range of the first hit
  vec2 apart_m;     // the least and the most that another's is beyond it, where an error was asked for
  uint hits;
  uint lit; // sum over the hits, diodes
};

void see_nothing(out PixelSum sum) {
  [[unroll]] for (uint p = 0; p < planes; ++p)
    sum.z[p] = vec4(0.0);
  sum.terms = vec3(0.0);
  sum.apart_m = vec2(0.0);
  sum.range = sum.depth = sum.reference_m = real(0.0);
  sum.hits = sum.lit = 0u;
}

// The turns per metre of range of `plane` of the sum.
Real turns_per_m(Frequency frequency, uint plane) {
  return multiply(real(frequency.turns_per_m.x, frequency.turns_per_m.y), real(float(plane + 1)));
}

// Where a frame's channels are.
struct Channels {
  uvec2 values; // pair by pair
  uint padded_pixels;
};

void store(Channels to, uint channel, uint pixel, uint word) {
  Words(to.values).at[2 * (channel / 2 * to.padded_pixels + pixel) + channel % 2] = word;
}
// To `channel`, which is even, and the next.
void store_pair(Channels to, uint channel, uint pixel, uvec2 words) {
  store_words(to.values, channel / 2 * to.padded_pixels + pixel, words);
}
void store(Channels to, uint channel, uint pixel, float value) { store(to, channel, pixel, floatBitsToUint(value)); }

// |z| without overflow or underflow of the squares.
float magnitude(vec2 z) {
  if (z == vec2(0.0))
    return 0.0;
  float larger = max(abs(z.x), abs(z.y));
  vec2 scaled = z / larger;
  return larger * sqrt(dot(scaled, scaled));
}

// exp(j 2 pi k / N).
vec2 tap_phasor(uint k) {
  float turns = float(k % taps) / float(taps);
  return unit_phasor(turns > 0.5 ? turns - 1.0 : turns);
}

// The return of a tone, all of its phase.
vec2 whole_return(PixelSum sum, Frequency frequency, uint plane) {
  float turns = turn_fraction(multiply(sum.reference_m, turns_per_m(frequency, plane)));
  vec2 z = complex_multiply(compensated_value(sum.z[plane]), unit_phasor(turns));
  return waveform == waveform_sine ? z : Floats(frequency.harmonics).at[plane] * z;
}

// The N correlation samples, up to the amplitude's scale.
void find_taps(PixelSum sum, Frequency frequency, out float tap[taps]) {
  if (waveform == waveform_square) {
    [[unroll]] for (uint k = 0; k < taps; ++k) {
      uint distinct = taps % 2 == 0 ? k % (taps / 2) : k;
      vec2 pair = compensated_value(sum.z[distinct / 2]);
      float value = distinct % 2 == 0 ? pair.x : pair.y;
      tap[k] = k == distinct ? value : -value;
    }
    return;
  }
  [[unroll]] for (uint k = 0; k < taps; ++k)
    tap[k] = 0.0;
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    vec2 z = whole_return(sum, frequency, p);
    [[unroll]] for (uint k = 0; k < taps; ++k)
      tap[k] += dot(z, tap_phasor(k * (p + 1)));
  }
}

// The return that the camera makes of its taps.
vec2 demodulate(float tap[taps]) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint k = 0; k < taps; ++k)
    z += tap[k] * tap_phasor(k);
  return z * (2.0 / float(taps));
}

// The same without the taps: only harmonics that are 1 or N - 1 modulo N show. If there is none of these, z is exactly 0.
vec2 demodulate_harmonics(PixelSum sum, Frequency frequency) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    uint alias = (p + 1) % taps;
    if (alias == 1)
      z += whole_return(sum, frequency, p);
    else if (alias == taps - 1)
      z += whole_return(sum, frequency, p) * vec2(1.0, -1.0);
  }
  return z;
}

RealComplex precise_value(vec4 sum) { return RealComplex(real(sum.x, sum.z), real(sum.y, sum.w)); }

RealComplex scale_complex(RealComplex z, Real factor) { return RealComplex(multiply(z.re, factor), multiply(z.im, factor)); }

RealComplex add_complex(RealComplex a, RealComplex b) { return RealComplex(add(a.re, b.re), add(a.im, b.im)); }

// The same of square light, in Real: distinct taps lie two in a plane, and the later half of an even N follows from the first.
RealComplex demodulate_precisely(PixelSum sum) {
  RealComplex z = RealComplex(real(0.0), real(0.0));
  [[unroll]] for (uint k = 0; k < taps; ++k) {
    uint distinct = taps % 2 == 0 ? k % (taps / 2) : k;
    RealComplex pair = precise_value(sum.z[distinct / 2]);
    Real tap = distinct % 2 == 0 ? pair.re : pair.im;
    Real turns = real_turn_fraction(divide(real(float(k)), real(float(taps))));
    z = add_complex(z, scale_complex(real_unit_phasor(turns), k == distinct ? tap : negate(tap)));
  }
  return scale_complex(z, divide(real(2.0), real(float(taps))));
}

// As demodulate_harmonics.
RealComplex demodulate_harmonics_precisely(PixelSum sum, Frequency frequency) {
  RealComplex z = RealComplex(real(0.0), real(0.0));
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    uint alias = (p + 1) % taps;
    if (alias != 1 && alias != taps - 1)
      continue;
    Real turns = real_turn_fraction(multiply(sum.reference_m, turns_per_m(frequency, p)));
    RealComplex whole = complex_multiply(precise_value(sum.z[p]), real_unit_phasor(turns));
    whole = scale_complex(whole, real(Floats(frequency.harmonics).at[p]));
    z = add_complex(z, alias == 1 ? whole : RealComplex(whole.re, negate(whole.im)));
  }
  return z;
}

RealComplex precise_return(PixelSum sum, Frequency frequency) {
  return waveform == waveform_sine     ? precise_value(sum.z[0])
         : waveform == waveform_square ? demodulate_precisely(sum)
                                       : demodulate_harmonics_precisely(sum, frequency);
}

// A mean over the samples hit, to be rounded to float; not known where there is none.
struct MeanOfHits {
  Real exact;
  bool is_known;
};

float rounded(MeanOfHits mean) { return mean.is_known ? high(mean.exact) : nan(); }

// Stores what rounding took, and at the ends of its interval the distance's clamping; up to whole ambiguities.
void store_rests(Channels to, Frequency frequency, uint pixel, Real distance, float distance_m, MeanOfHits range) {
  if (keeps_rests == 0)
    return;
  vec2 rests = vec2(high(add(distance, real(-distance_m))), rest(range.exact));
  store_pair(to, frequency.first_channel + rest_channels, pixel, floatBitsToUint(rests));
}

// `turns` in [-1, 1]. Phase and distance are not known where nothing returns. Returns the distance, or 0.
float store_phase(Channels to, Frequency frequency, uint pixel, float amplitude, Real turns, MeanOfHits range) {
  bool is_known = amplitude > 0.0;
  turns = add(turns, real(high(turns) < 0.0 ? 1.0 : 0.0));
  turns = add(turns, real(high(turns) >= 1.0 ? -1.0 : 0.0));
  Real two_pi = real(6.2831855, -1.7484555e-7);
  // Rounding to float must not reach the end of the half-open interval.
  uint channel = frequency.first_channel;
  float phase_rad = clamp(high(multiply(turns, two_pi)), 0.0, frequency.below.x);
  store_pair(to, channel + channel_amplitude, pixel, floatBitsToUint(vec2(amplitude, is_known ? phase_rad : nan())));
  Real distance = multiply(turns, real(frequency.ambiguity_m.x, frequency.ambiguity_m.y));
  float distance_m = clamp(high(distance), 0.0, frequency.below.y);
  // As exact as a float is: the largest below may be a whole unit off what rounds to the end, which is 0 as well.
  float rounded_m = distance_m;
  if (precise_sum != 0 && high(distance) > frequency.below.y)
    distance_m = 0.0;
  store_pair(to, channel + channel_distance_m, pixel, floatBitsToUint(vec2(is_known ? distance_m : nan(), rounded(range))));
  store_rests(to, frequency, pixel, distance, distance_m, range);
  return is_known ? rounded_m : 0.0;
}

// The mean of what was summed over the samples hit; `samples`: S x S.
MeanOfHits mean_over_hits(Real sum, PixelSum pixel, uint samples) {
  if (samples > 1)
    sum = divide(sum, real(float(max(pixel.hits, 1u))));
  return MeanOfHits(sum, pixel.hits > 0u);
}

// What the bound of a pixel's return asks for: |z| over what one sample's unit return would come to, and the distance, or 0.
struct Return {
  float size, distance_m;
};

// Of square light, tap 0 at no phase is the sum of the weights as well.
Return store_mean(Channels to, Frequency frequency, float scale, uint pixel, PixelSum sum) {
  float size = precise_sum != 0 ? high(precise_value(sum.z[0]).re) : compensated_value(sum.z[0]).x;
  store(to, frequency.first_channel, pixel, scale * max(size, 0.0));
  return Return(size, 0.0);
}

// `samples`: S x S of the pixel.
Return store_return(Channels to, Frequency frequency, uint samples, uint pixel, PixelSum sum) {
  float scale = frequency.amplitude_scale / float(samples);
  if (is_mean(frequency))
    return store_mean(to, frequency, scale, pixel, sum);
  float tap[taps];
  if ((waveform == waveform_square && precise_sum == 0) || keep_taps != 0)
    find_taps(sum, frequency, tap);
  if (keep_taps != 0)
    [[unroll]] for (uint k = 0; k < taps; ++k)
      store(to, frequency.first_channel + channel_tap + k, pixel, scale * tap[k]);
  // A sine's phase stays relative to the range, which makes it exact to the last bit of the output.
  vec2 z;
  Real angle;
  if (precise_sum != 0) {
    RealComplex whole = precise_return(sum, frequency);
    z = vec2(high(whole.re), high(whole.im));
    angle = real_angle_turns(whole);
  } else {
    z = waveform == waveform_sine     ? compensated_value(sum.z[0])
        : waveform == waveform_square ? demodulate(tap)
                                      : demodulate_harmonics(sum, frequency);
    angle = real(angle_turns(z));
  }
  float size = magnitude(z);
  float amplitude = scale * size;
  Real turns = waveform == waveform_sine ? multiply(sum.reference_m, turns_per_m(frequency, 0)) : real(0.0);
  turns = add(add(turns, negate(round_to_whole(turns))), angle);
  return Return(size, store_phase(to, frequency, pixel, amplitude, turns, mean_over_hits(sum.range, sum, samples)));
}

void store_ground_truth(Channels to, uint samples, uint pixel, PixelSum sum) {
  vec2 truth = vec2(float(sum.hits) / float(samples), rounded(mean_over_hits(sum.depth, sum, samples)));
  store_pair(to, channel_coverage, pixel, floatBitsToUint(truth));
}

void store_lit(Channels to, uint channel, uint diodes, uint pixel, PixelSum sum) {
  store(to, channel, pixel, float(sum.lit) / float(max(sum.hits * diodes, 1u)));
}

void store_ids(Channels to, uvec2 ids, uint object, uint pixel) {
  store_pair(to, channel_triangle_id, pixel, ids.x != 0u ? uvec2(ids.y, object) : uvec2(no_triangle));
}

// Errors of weights as distance. One that all weights have turns the sum by sum w |sin| / |sum| times it, which even_part bounds
// (engine/error_budget/rounding_bound.cpp), and as (sum w |sin|)^2 <=
// sum w * sum w sin^2 <= (sum w)^2 - |sum|^2 that is at most sqrt(condition^2 - 1). `largest`: of the condition, which is off itself.
// The same holds of `of_beams`, the root of the mean square of errors that differ, but for the even part.
// `common_per_weight_m`: even_part of per_weight_m.
float weights_error_m(Frequency frequency, float per_weight_m, float common_per_weight_m, float condition, float largest, float weights,
                      float of_beams) {
  float any_m = frequency.any_weight_m * sqrt(max(largest * largest - 1.0, 0.0));
  float of_beams_m = of_beams > 0.0 ? of_beams * min(per_weight_m * condition, any_m) : 0.0;
  return frequency.weight_error * min(common_per_weight_m * condition, any_m) + of_beams_m + per_weight_m * weights;
}

const float output_rounding = 5.9604645e-8; // of a distance to float, 2^-24 of it

// The bound (Frequency), given what is known to add to the sum's own error, and how much the samples' ranges differ by.
// `terms` as in PixelSum.
Errors errors_of(Frequency frequency, vec3 terms, Return of_pixel, Errors added, float apart_m) {
  float condition = terms.x > 0.0 ? terms.x / of_pixel.size : 0.0; // infinite where all cancels
  float weights = terms.y > 0.0 ? terms.y / of_pixel.size : 0.0;
  float of_beams = terms.x > 0.0 && terms.z > 0.0 ? sqrt(terms.z / terms.x) : 0.0;
  float all_of_beams = of_beams > 0.0 ? of_beams * condition : 0.0;
  // A sum that is off by this part of itself is turned by more than a small part would turn it: by the arcsine.
  float relative = (frequency.amplitude_per_condition + added.amplitude) * condition + frequency.per_weight * (weights + all_of_beams);
  float grown = relative < 1.0 ? 1.0 / (1.0 - relative) : 1.0 / 0.0;
  float largest = condition * (1.0 + relative + 1e-6) * grown;
  float near_per_weight_m = min(frequency.near_per_weight_m + frequency.per_weight * apart_m, frequency.per_weight_m);
  float near_common_m =
      min(frequency.near_even_part * frequency.near_per_weight_m + frequency.per_weight * apart_m, near_per_weight_m);
  float near_m = (frequency.near_per_condition_m + frequency.per_apart * apart_m + added.distance_m) * condition +
                 weights_error_m(frequency, near_per_weight_m, near_common_m, condition, largest, weights, of_beams);
  float any_m = (frequency.per_condition_m + added.distance_m) * condition +
                weights_error_m(frequency, frequency.per_weight_m, frequency.even_part * frequency.per_weight_m, condition, largest, weights, of_beams);
  float output_m = output_rounding * of_pixel.distance_m;
  return Errors(output_m + min(frequency.near_fixed_m + near_m * grown, frequency.fixed_m + any_m * grown),
                frequency.amplitude_fixed + relative);
}

// The sum of the amplitudes of the harmonics that N taps take for the fundamental: the most that multiplies a term in all.
float largest_amplitude(Frequency frequency) {
  if (waveform != waveform_harmonics)
    return 1.0;
  float sum = 0.0;
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    uint alias = (p + 1) % taps;
    sum += alias == 1 || alias == taps - 1 ? abs(Floats(frequency.harmonics).at[p]) : 0.0;
  }
  return sum;
}

bool is_kept(Frequency frequency, Errors errors) {
  return errors.distance_m <= frequency.limit_m && errors.amplitude <= frequency.amplitude_limit;
}

// The errors of a return for the frame's claim (ClaimsConstants): both negative where they are not within what was asked for,
// or no numbers.
vec2 held(Frequency frequency, Errors errors) {
  if (is_kept(frequency, errors))
    return vec2(errors.distance_m, errors.amplitude);
  return vec2(errors.distance_m > 0.0 ? -errors.distance_m : -1.0, errors.amplitude > 0.0 ? -errors.amplitude : -1.0);
}

// Stores the bound of a return; not known where there is none.
void store_bound(Channels to, Frequency frequency, uint pixel, Return of_pixel, Errors errors) {
  if (keeps_bounds != 0 && !is_mean(frequency))
    store(to, frequency.first_channel + bound_channel, pixel, of_pixel.size > 0.0 ? errors.distance_m : nan());
}

#endif
