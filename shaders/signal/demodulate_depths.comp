#version 460
// demodulate.comp for depth records. There is no branch around it all, so that lavapipe reads what all pixels share once for
// all lanes; beyond the last pixel is room for invocations that only pad.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/grid.glsl"
#include "shaders/view/meet.glsl"
#include "shaders/view/points.glsl"
#include "shaders/signal/demodulation.glsl"

layout(push_constant, std430) uniform Constants { DepthDemodulationConstants constants; };
layout(constant_id = constant_general_chip) const uint general_chip = 0;
layout(constant_id = constant_is_only) const uint is_only = 0;
layout(constant_id = constant_side) const uint side = 1; // S
layout(constant_id = constant_frequencies) const uint frequencies = 1;
layout(constant_id = constant_one_backscatter) const uint one_backscatter = 0;
layout(constant_id = constant_beams) const uint beams = 0;
const uint all_planes = frequencies * planes;

// The p-th plane of frequency f's sum, but for the backscatter.
vec2 load_sum(uint f, uint p, uint i) {
  uint at = (f * planes + p) * constants.plane + i;
  return is_only != 0 ? uintBitsToFloat(load_words(constants.sum, at)) : compensated_value(load_vec4(constants.sum, at));
}

// B over the cosine of the surface that sample i sees at `point`.
float load_backscatter(uint i, vec3 ray, Real3 point) {
  uint triangle = one_backscatter != 0 ? 0u : load_record_ids(constants.records, i).y;
  TrianglePlane plane;
  plane.backscatter = constants.backscatter;
  if (one_backscatter == 0)
    plane.backscatter = uintBitsToFloat(load_words(constants.planes, 6 * triangle + 4).x);
  return backscatter_of(constants.shapes, constants.surfaces, ray, point, triangle, plane);
}

// `z` as in PixelSum, frequency by frequency.
void add_sample(inout PixelSum sum, inout vec4 z[all_planes], Frequency of[frequencies], uvec2 at) {
  uint i = at.y * constants.grid.columns + at.x;
  Real depth = load_record_depth(constants.records, i);
  Real3 ray = ray_of(at, constants.grid, constants.chip, general_chip != 0);
  Real3 point = point_at_depth(ray, depth);
  Real range = length3(point);
  float backscatter = load_backscatter(i, high3(ray), point);
  bool hits = high(depth) != 0.0, shines = hits && backscatter > 0.0; // black may not be a number
  if (sum.hits == 0u)
    sum.reference_m = range;
  Real excess_m = add(range, negate(sum.reference_m));
  [[unroll]] for (uint f = 0; f < frequencies; ++f)
    [[unroll]] for (uint p = 0; p < planes; ++p) {
      vec2 value = load_sum(f, p, i);
      if (side > 1)
        value = complex_multiply(value, unit_phasor(turn_fraction(multiply(excess_m, turns_per_m(of[f], p)))));
      z[f * planes + p] = compensated_add(z[f * planes + p], shines ? backscatter * value : vec2(0.0));
    }
  if (keeps_terms != 0) {
    float excess = hits ? high(excess_m) : 0.0;
    float of_beams = beams != 0 ? load_sum(frequencies, 1, i).x : 0.0;
    sum.terms += shines ? backscatter * vec3(load_sum(frequencies, 0, i), of_beams) : vec3(0.0);
    sum.apart_m = vec2(min(sum.apart_m.x, excess), max(sum.apart_m.y, excess));
  }
  sum.range = add(sum.range, hits ? range : real(0.0));
  sum.depth = add(sum.depth, hits ? depth : real(0.0));
  sum.hits += hits ? 1u : 0u;
  if (lit_is_kept != 0)
    sum.lit += hits ? Words(constants.lit).at[i] : 0u;
}

// Stores the bound and the errors of frequency f.
void hold(Channels to, Frequency frequency, uint f, uint pixel, PixelSum sum, Return of_pixel) {
  vec3 terms = largest_amplitude(frequency) * sum.terms;
  Errors errors = errors_of(frequency, terms, of_pixel, Errors(0.0, 0.0), sum.apart_m.y - sum.apart_m.x);
  store_bound(to, frequency, pixel, of_pixel, errors);
  store_words(constants.errors, f * constants.padded_pixels + pixel, floatBitsToUint(held(frequency, errors)));
}

void store_truth(Channels to, uint pixel, uvec2 first, PixelSum sum) {
  store_ground_truth(to, side * side, pixel, sum);
  uvec2 at = first + (side - 1) / 2; // the upper left one of an even number
  uvec2 ids = load_record_ids(constants.records, at.y * constants.grid.columns + at.x);
  store_ids(to, ids, load_words(constants.planes, 6 * ids.y + 4).y, pixel);
}

void main() {
  Frequency of[frequencies];
  vec4 z[all_planes];
  [[unroll]] for (uint f = 0; f < frequencies; ++f)
    of[f] = Frequencies(constants.frequency).at[f];
  [[unroll]] for (uint p = 0; p < all_planes; ++p)
    z[p] = vec4(0.0);
  uint pixel = gl_GlobalInvocationID.x;
  uint columns = constants.grid.columns / side;
  uvec2 first = side * row_by_row(min(pixel, constants.pixels - 1), columns, constants.grid.inverse_columns * float(side));
  PixelSum sum;
  see_nothing(sum);
  for (uint y = 0; y < side; ++y)
    for (uint x = 0; x < side; ++x)
      add_sample(sum, z, of, first + uvec2(x, y));
  Channels to = Channels(constants.channels, constants.padded_pixels);
  [[unroll]] for (uint f = 0; f < frequencies; ++f) {
    [[unroll]] for (uint p = 0; p < planes; ++p)
      sum.z[p] = z[f * planes + p];
    Return of_pixel = store_return(to, of[f], side * side, pixel, sum);
    if (keeps_terms != 0)
      hold(to, of[f], f, pixel, sum, of_pixel);
  }
  if (ground_truth != 0)
    store_truth(to, pixel, first, sum);
  if (lit_is_kept != 0)
    store_lit(to, of[0].lit_channel, of[0].diodes, pixel, sum);
}
