#version 460
// The sum over the diodes of one run, for every sample, by moments.
// As a straight line one dispatch is one unrolled run, without a branch, so that lavapipe reads the diodes once for all lanes;
// else a loop over the blocks, which suits GPUs.
#extension GL_GOOGLE_include_directive : require
#ifdef RECORD_DEPTH
#include "shaders/light/accumulate_depths.glsl"
#define MOMENT_OF_RUN(i, k) moment_of_run(i, k)
#else
#include "shaders/light/accumulate.glsl"
#endif
#define VISIBILITY_OF_BLOCK(i, block) visibility_of_block(i, block)
#include "shaders/light/moments.glsl"

void add_tone(uint t, uint i, float moment[moments], ReferencePath path, LightRun run, float backscatter) {
  add_to_plane(t, i, backscatter, tone_return(moment, path, run, Tones(constants.tones).at[t]));
}

#ifdef RECORD_DEPTH
layout(constant_id = constant_keeps_terms) const uint keeps_terms = 0;

// In planes of their own behind the tones'.
void add_terms(uint i, float backscatter, vec3 terms) {
  if (keeps_terms != 0)
    add_to_plane(tones, i, backscatter, terms.xy);
  if (keeps_terms != 0 && beams != 0)
    add_to_plane(tones + 1, i, backscatter, vec2(terms.z, 0.0));
}
#endif

// More of them would take long to compile, and are seldom.
const uint unrolled_tones = 16;

void main() {
  uint i = sample_of_invocation();
  LightRun run = LightRuns(constants.run).at;
  Point point;
  ReferencePath path = load_point(i, run, point);
  float moment[moments];
  Weights weights;
  sum_run(i, point, run, constants.diodes, 0u, constants.blocks, moment, weights);

  float backscatter = load_backscatter(i);
  add_terms(i, backscatter, terms_of(weights, point, run));
  if (tones <= unrolled_tones) {
    [[unroll]] for (uint t = 0; t < tones; ++t)
      add_tone(t, i, moment, path, run, backscatter);
  } else {
    for (uint t = 0; t < tones; ++t)
      add_tone(t, i, moment, path, run, backscatter);
  }
}
