#version 460
// The channels of each pixel from the sums of its samples, in a fixed order; of one modulation frequency.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/pixel_list.glsl"
#include "shaders/shared/buffers.glsl"
#include "shaders/signal/demodulation.glsl"

layout(push_constant, std430) uniform Constants { DemodulationConstants constants; };
layout(constant_id = constant_listed) const uint listed = 0;
layout(constant_id = constant_depth_records) const uint depth_records = 0;
layout(constant_id = constant_passes_on) const uint passes_on = 0;
layout(constant_id = constant_holds_pixels) const uint holds_pixels = 0;
layout(constant_id = constant_beams) const uint beams = 0;

// Adds `z`, turned, in Real; the sum stays a pair.
vec4 add_precisely(vec4 sum, vec4 z, Real turns) {
  RealComplex value = RealComplex(real(z.x, z.z), real(z.y, z.w));
  if (waveform != waveform_square)
    value = complex_multiply(value, real_unit_phasor(real_turn_fraction(turns)));
  Real re = add(real(sum.x, sum.z), value.re), im = add(real(sum.y, sum.w), value.im);
  return vec4(high(re), high(im), rest(re), rest(im));
}

void add_return(inout PixelSum sum, Frequency frequency, uint i, Real excess_m) {
  [[unroll]] for (uint p = 0; p < planes; ++p) {
    vec4 pair = load_vec4(constants.sum, p * constants.plane + i);
    if (precise_sum != 0) {
      sum.z[p] = add_precisely(sum.z[p], pair, multiply(excess_m, turns_per_m(frequency, p)));
      continue;
    }
    vec2 z = compensated_value(pair);
    if (waveform != waveform_square) // each plane is a harmonic
      z = complex_multiply(z, unit_phasor(turn_fraction(multiply(excess_m, turns_per_m(frequency, p)))));
    sum.z[p] = compensated_add(sum.z[p], z);
  }
}

void sum_samples(uint pixel, Frequency frequency, out PixelSum sum) {
  see_nothing(sum);
  uint count = constants.samples * constants.samples;
  for (uint s = 0; s < count; ++s) {
    uint i = s * constants.padded_pixels + pixel;
    Real3 position = load_position(constants.position, i);
    if (high(position.z) == 0.0)
      continue;
    Real range = length3(position);
    if (sum.hits == 0u)
      sum.reference_m = range;
    Real excess_m = add(range, negate(sum.reference_m));
    add_return(sum, frequency, i, excess_m);
    sum.range = add(sum.range, range);
    sum.depth = add(sum.depth, position.z);
    sum.hits += 1u;
    if (lit_is_kept != 0)
      sum.lit += Words(constants.lit).at[depth_records != 0 ? record_index(i, constants.padded_pixels, constants.columns, constants.samples)
                                                             : i];
    if (keeps_terms != 0) {
      sum.terms += vec3(max(0.0, Floats(constants.terms).at[i]), Floats(constants.terms).at[constants.plane + i],
                        beams != 0 ? Floats(constants.terms).at[2 * constants.plane + i] : 0.0);
      sum.apart_m = vec2(min(sum.apart_m.x, high(excess_m)), max(sum.apart_m.y, high(excess_m)));
    }
  }
}

// The IDs of the sample nearest the pixel's centre; ties go up and left.
uvec2 central_ids(uint pixel) {
  uint middle = (constants.samples - 1u) / 2u;
  uvec2 at = uvec2(pixel % constants.columns, pixel / constants.columns);
  uvec2 extent = uvec2(constants.columns, constants.pixels / constants.columns);
  return load_ids(constants.ids, id_index(at, uvec2(middle), extent, constants.samples, tiled != 0), depth_records);
}

// A pixel is listed once, whichever of its frequencies comes first: its first sample's terms are turned negative then.
void pass_on(uint pixel) {
  Floats terms = Floats(constants.terms);
  if (terms.at[pixel] < 0.0)
    return;
  terms.at[pixel] = -1.0;
  append_pixel(PixelLists(constants.later), pixel);
}

// A return keeps what was asked for, or its pixel passes on, or the return is counted; for all pixels together by claims.comp.
void hold(Channels to, Frequency frequency, uint pixel, PixelSum sum, Return of_pixel) {
  vec3 terms = largest_amplitude(frequency) * sum.terms;
  float apart_m = sum.apart_m.y - sum.apart_m.x;
  Errors errors = errors_of(frequency, terms, of_pixel, Errors(0.0, 0.0), apart_m);
  store_bound(to, frequency, pixel, of_pixel, errors);
  if (holds_pixels != 0)
    store_words(constants.violations, pixel, floatBitsToUint(held(frequency, errors)));
  else if (is_kept(frequency, errors))
    report_kept(constants.violations, errors);
  else if (passes_on != 0)
    pass_on(pixel);
  else
    report_violation(constants.violations, errors);
}

void main() {
  Frequency frequency = Frequencies(constants.frequency).at[0]; // before any branch, where lavapipe loads once for all lanes
  uint pixel = gl_GlobalInvocationID.x;
  if (listed != 0)
    pixel = listed_pixel(PixelLists(constants.list), pixel, constants.padded_pixels);
  if (pixel >= constants.pixels)
    return;
  PixelSum sum;
  sum_samples(pixel, frequency, sum);
  uint samples = constants.samples * constants.samples;
  Channels to = Channels(constants.channels, constants.padded_pixels);
  Return of_pixel = store_return(to, frequency, samples, pixel, sum);
  if (keeps_terms != 0)
    hold(to, frequency, pixel, sum, of_pixel);
  if (ground_truth != 0) {
    store_ground_truth(to, samples, pixel, sum);
    uvec2 ids = central_ids(pixel);
    store_ids(to, ids, ids.x != 0u ? Planes(constants.planes).at[ids.y].object : no_triangle, pixel);
  }
  if (lit_is_kept != 0)
    store_lit(to, constants.lit_channel, constants.diodes, pixel, sum);
}
