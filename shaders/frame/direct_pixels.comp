#version 460
// Turns a depth record into a pixel's channels at once, where a pixel is one sample and all sources are one run. This is
// accumulate.comp and demodulate_depths.comp without the sum between, which would be stored, and loaded with the depth anew.
#extension GL_GOOGLE_include_directive : require
#include "shaders/light/accumulate_depths.glsl"
#define VISIBILITY_OF_BLOCK(i, block) visibility_of_block(i, block)
#define MOMENT_OF_RUN(i, k) moment_of_run(i, k)
#include "shaders/light/moments.glsl"
#include "shaders/signal/demodulation.glsl"
#include "shaders/view/points.glsl"

layout(constant_id = constant_one_backscatter) const uint one_backscatter = 0;
layout(constant_id = constant_holds_pixels) const uint holds_pixels = 0;
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer DirectPixelsOf {
  DirectPixels at;
  Frequency of[]; // here, as lavapipe loads once for all lanes only what push constants lead to
};

// B over the cosine of the surface.
float backscatter_at(DirectPixels direct, uint record, vec3 ray, Real3 point) {
  uint triangle = one_backscatter != 0 ? 0u : load_record_ids(constants.records, record).y;
  TrianglePlane plane;
  plane.backscatter = direct.backscatter;
  if (one_backscatter == 0)
    plane.backscatter = uintBitsToFloat(load_words(constants.planes, 6 * triangle + 4).x);
  return backscatter_of(direct.shapes, direct.surfaces, ray, point, triangle, plane);
}

// Stores what a return may be off by, in place of its sum.
void hold(Channels to, DirectPixels direct, uint t, Frequency frequency, uint pixel, vec3 terms, Return of_pixel) {
  if (holds_pixels == 0)
    return;
  Errors errors = errors_of(frequency, terms, of_pixel, Errors(0.0, 0.0), 0.0);
  store_bound(to, frequency, pixel, of_pixel, errors);
  store_words(direct.errors, t * constants.plane + pixel, floatBitsToUint(held(frequency, errors)));
}

void store_nothing(uint i, DirectPixelsOf output_of) {
  PixelSum sum;
  see_nothing(sum);
  Channels to = Channels(output_of.at.channels, constants.plane);
  [[unroll]] for (uint t = 0; t < tones; ++t) {
    Return nothing = store_return(to, output_of.of[t], 1, i, sum);
    hold(to, output_of.at, t, output_of.of[t], i, vec3(0.0), nothing);
  }
  if (lit_is_kept != 0)
    store_lit(to, output_of.of[0].lit_channel, output_of.of[0].diodes, i, sum);
}

void main() {
  uint i = sample_of_invocation(), record = min(i, constants.samples - 1); // what only pads has no record
  DirectPixelsOf output_of = DirectPixelsOf(constants.sum);
  if (block_list == blocks_empty) {
    store_nothing(i, output_of);
    return;
  }
  DirectPixels direct = output_of.at;
  LightRun run = LightRuns(constants.run).at;
  Point point;
  Real3 ray, position;
  ReferencePath path = load_point(i, run, point, ray, position);
  float moment[moments];
  Weights weights;
  sum_run(i, point, run, constants.diodes, 0u, constants.blocks, moment, weights);

  float backscatter = backscatter_at(direct, record, high3(ray), position);
  bool hits = high(position.z) != 0.0, shines = hits && backscatter > 0.0; // black may not be a number
  PixelSum sum;
  see_nothing(sum);
  sum.hits = hits ? 1u : 0u;
  sum.reference_m = sum.range = path.range;
  Channels to = Channels(direct.channels, constants.plane);
  vec3 terms = shines ? backscatter * terms_of(weights, point, run) : vec3(0.0);
  [[unroll]] for (uint t = 0; t < tones; ++t) {
    vec2 z = tone_return(moment, path, run, Tones(constants.tones).at[t]);
    sum.z[0] = vec4(shines ? backscatter * z : vec2(0.0), 0.0, 0.0);
    Return of_pixel = store_return(to, output_of.of[t], 1, i, sum);
    hold(to, direct, t, output_of.of[t], i, terms, of_pixel);
  }
  if (lit_is_kept != 0) {
    sum.lit = hits ? Words(direct.lit).at[record] : 0u;
    store_lit(to, output_of.of[0].lit_channel, output_of.of[0].diodes, i, sum);
  }
}
