#version 460
// Phase, amplitude, distance, taps and ground truth of each pixel from the sums of its samples, in a fixed order; of one
// modulation frequency.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "buffers.glsl"
#include "compensated.glsl"
#include "elementary.glsl"
#include "real.glsl"
#include "real_elementary.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { ResolveConstants constants; };
layout(constant_id = constant_planes) const uint planes = 1;
layout(constant_id = constant_resolve_waveform) const uint waveform = waveform_sine;
layout(constant_id = constant_resolve_taps) const uint taps = 4;
layout(constant_id = constant_keep_taps) const uint keep_taps = 0;
layout(constant_id = constant_ground_truth) const uint ground_truth = 1;
layout(constant_id = constant_resolve_tiled) const uint tiled = 0;
layout(constant_id = constant_resolve_lit) const uint shadowed = 0;
layout(constant_id = constant_resolve_precise) const uint precise_sum = 0;

float nan() { return uintBitsToFloat(0x7fc00000u); }

struct PixelSum {
  vec4 z[planes]; // compensated; of a tone relative to twice the reference range
  Real range;     // sum over the hits, m
  Real depth;
  Real reference_m; // range of the first hit
  uint hits;
  uint lit; // sum over the hits, diodes
};

Real turns_per_m(uint plane) {
  return multiply(real(constants.turns_per_m.x, constants.turns_per_m.y), real(float(plane + 1)));
}

// Adds `z`, turned, in Real; the sum stays a pair.
vec4 add_precisely(vec4 sum, vec4 z, Real turns) {
  RealComplex value = RealComplex(real(z.x, z.z), real(z.y, z.w));
  if (waveform != waveform_square)
    value = complex_multiply(value, real_unit_phasor(real_turn_fraction(turns)));
  Real re = add(real(sum.x, sum.z), value.re), im = add(real(sum.y, sum.w), value.im);
  return vec4(high(re), high(im), rest(re), rest(im));
}

void add_return(inout PixelSum sum, uint i, Real excess_m) {
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    vec4 pair = Vec4s(constants.sum).at[p * constants.plane + i];
    if (precise_sum != 0) {
      sum.z[p] = add_precisely(sum.z[p], pair, multiply(excess_m, turns_per_m(p)));
      continue;
    }
    vec2 z = compensated_value(pair);
    if (waveform != waveform_square) // each plane is a harmonic
      z = complex_multiply(z, unit_phasor(turn_fraction(multiply(excess_m, turns_per_m(p)))));
    sum.z[p] = compensated_add(sum.z[p], z);
  }
}

void sum_samples(uint pixel, out PixelSum sum) {
  [[unroll]] for (uint p = 0; p < planes; ++p)
    sum.z[p] = vec4(0.0);
  sum.range = sum.depth = sum.reference_m = real(0.0);
  sum.hits = sum.lit = 0u;
  uint count = constants.samples * constants.samples;
  for (uint s = 0; s < count; ++s) {
    uint i = s * constants.padded_pixels + pixel;
    vec3 hi = load_vec3(constants.position_hi, i);
    if (hi == vec3(0.0))
      continue;
    Real3 position = real3(hi, load_vec3(constants.position_lo, i));
    Real range = length3(position);
    if (sum.hits == 0u)
      sum.reference_m = range;
    add_return(sum, i, add(range, negate(sum.reference_m)));
    sum.range = add(sum.range, range);
    sum.depth = add(sum.depth, position.z);
    sum.hits += 1u;
    if (shadowed != 0)
      sum.lit += Words(constants.lit).at[i];
  }
}

void store(uint channel, uint pixel, uint word) {
  Words(constants.channels).at[channel * constants.padded_pixels + pixel] = word;
}
void store(uint channel, uint pixel, float value) { store(channel, pixel, floatBitsToUint(value)); }

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
vec2 tone_return(PixelSum sum, uint plane) {
  float turns = turn_fraction(multiply(sum.reference_m, turns_per_m(plane)));
  vec2 z = complex_multiply(compensated_value(sum.z[plane]), unit_phasor(turns));
  return waveform == waveform_sine ? z : Floats(constants.harmonics).at[plane] * z;
}

// The N correlation samples, up to the amplitude's scale.
void find_taps(PixelSum sum, out float tap[taps]) {
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
    vec2 z = tone_return(sum, p);
    [[unroll]] for (uint k = 0; k < taps; ++k)
      tap[k] += dot(z, tap_phasor(k * (p + 1)));
  }
}

// What the camera makes of its taps.
vec2 demodulate(float tap[taps]) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint k = 0; k < taps; ++k)
    z += tap[k] * tap_phasor(k);
  return z * (2.0 / float(taps));
}

// The same without the taps: of harmonic h, only h = 1 and N - 1 modulo N show. If there is none of these, z is exactly 0.
vec2 demodulate_harmonics(PixelSum sum) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    uint alias = (p + 1) % taps;
    if (alias == 1)
      z += tone_return(sum, p);
    else if (alias == taps - 1)
      z += tone_return(sum, p) * vec2(1.0, -1.0);
  }
  return z;
}

// `turns` in [-1, 1].
void store_phase(uint pixel, Real turns) {
  turns = add(turns, real(high(turns) < 0.0 ? 1.0 : 0.0));
  turns = add(turns, real(high(turns) >= 1.0 ? -1.0 : 0.0));
  Real two_pi = real(6.2831855, -1.7484555e-7);
  // Rounding to float must not reach the end of the half-open interval.
  uint channel = constants.first_channel;
  store(channel + channel_phase_rad, pixel, clamp(high(multiply(turns, two_pi)), 0.0, constants.limits.x));
  Real distance = multiply(turns, real(constants.ambiguity_m.x, constants.ambiguity_m.y));
  store(channel + channel_distance_m, pixel, clamp(high(distance), 0.0, constants.limits.y));
}

void store_return(uint pixel, PixelSum sum) {
  float scale = constants.amplitude_scale / float(constants.samples * constants.samples);
  float tap[taps];
  if (waveform == waveform_square || keep_taps != 0)
    find_taps(sum, tap);
  if (keep_taps != 0)
    [[unroll]] for (uint k = 0; k < taps; ++k)
      store(constants.first_channel + channel_first_tap + k, pixel, scale * tap[k]);
  // A sine's phase stays relative to the range, which makes it exact to the last bit of the output.
  vec2 z = waveform == waveform_sine     ? compensated_value(sum.z[0])
           : waveform == waveform_square ? demodulate(tap)
                                         : demodulate_harmonics(sum);
  float amplitude = scale * magnitude(z);
  store(constants.first_channel + channel_amplitude, pixel, amplitude);
  if (amplitude == 0.0) {
    store(constants.first_channel + channel_phase_rad, pixel, nan());
    store(constants.first_channel + channel_distance_m, pixel, nan());
    return;
  }
  Real turns = waveform == waveform_sine ? multiply(sum.reference_m, turns_per_m(0)) : real(0.0);
  turns = add(turns, negate(round_to_whole(turns)));
  store_phase(pixel, add(turns, real(angle_turns(z))));
}

void store_ground_truth(uint pixel, PixelSum sum) {
  Real hits = real(float(sum.hits));
  store(channel_range_m, pixel, sum.hits > 0u ? high(divide(sum.range, hits)) : nan());
  store(channel_z_m, pixel, sum.hits > 0u ? high(divide(sum.depth, hits)) : nan());
  if (shadowed != 0)
    store(constants.lit_channel, pixel, float(sum.lit) / float(max(sum.hits * constants.diodes, 1u)));
  store(channel_coverage, pixel, float(sum.hits) / float(constants.samples * constants.samples));
}

// Of the sample nearest the pixel's centre; ties go up and left.
void store_ids(uint pixel) {
  uint middle = (constants.samples - 1u) / 2u;
  uvec2 at = uvec2(pixel % constants.columns, pixel / constants.columns);
  uvec2 extent = uvec2(constants.columns, constants.pixels / constants.columns);
  uint i = tag_index(at, uvec2(middle), extent, constants.samples, tiled != 0);
  uvec2 tag = Tags(constants.tags).at[i];
  bool hit = tag.x != 0u;
  store(channel_triangle_id, pixel, hit ? tag.y : no_triangle);
  store(channel_object_id, pixel, hit ? Planes(constants.planes).at[tag.y].object : no_triangle);
}

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= constants.pixels)
    return;
  PixelSum sum;
  sum_samples(pixel, sum);
  store_return(pixel, sum);
  if (ground_truth != 0) {
    store_ground_truth(pixel, sum);
    store_ids(pixel);
  }
}
