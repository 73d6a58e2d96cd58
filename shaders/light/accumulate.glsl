// Which samples the accumulate pass sums, where their points are, and how a run's terms join the sum.
#ifndef PMDSIM_ACCUMULATE_GLSL
#define PMDSIM_ACCUMULATE_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/compensated.glsl"
#include "shaders/sampling/pixel_list.glsl"
#include "shaders/shared/constants.h"

layout(push_constant, std430) uniform Constants { AccumulateConstants constants; };
layout(constant_id = constant_is_first) const uint is_first = 0;
layout(constant_id = constant_listed) const uint listed = 0;
layout(constant_id = constant_bits_by_row) const uint bits_by_row = 0;
layout(constant_id = constant_keeps_terms) const uint keeps_terms = 0;

#define DIAGRAM_VALUES constants.diagrams
#include "shaders/light/sum.glsl"

uint sample_of_invocation() {
  uint i = gl_GlobalInvocationID.x;
  return listed != 0 ? listed_sample(PixelLists(constants.list), i, constants.padded_pixels) : i;
}

// The block's diodes that reach sample i, a bit each.
uint visibility_of_block(uint i, uint block) {
  if (shadowed == 0)
    return 0u;
  uint first = block * diodes_per_block;
  if (bits_by_row != 0)
    i = record_index(i, constants.padded_pixels, constants.columns, constants.samples);
  return Words(constants.visibility).at[first / diodes_per_bundle * constants.plane + i] >> first % diodes_per_bundle;
}

ReferencePath load_point(uint i, LightRun run, out Point point) {
  return see_point(load_position(constants.position, i), load_vec4(constants.surface, i), run, point);
}

float load_backscatter(uint i) { return Floats(constants.backscatter).at[i]; }

// Adds a sample's terms without their phases, where pixels have to say how much of the sum their phases cancel.
void add_terms(uint i, float backscatter, vec3 terms) {
  if (keeps_terms == 0 || constants.adds_terms == 0)
    return;
  Floats sums = Floats(constants.terms);
  vec3 scattered = backscatter > 0.0 ? backscatter * terms : vec3(0.0);
  [[unroll]] for (uint kind = 0; kind < (beams != 0 ? 3 : 2); ++kind) {
    uint at = kind * constants.plane + i;
    sums.at[at] = is_first != 0 ? scattered[kind] : scattered[kind] + sums.at[at];
  }
}

// Adds a run's two terms, times the backscatter, to a plane of the sum. A sample that hit nothing adds nothing, not even
// NaN.
void add_to_plane(uint plane, uint i, float backscatter, vec2 value) {
  vec2 term = backscatter > 0.0 ? backscatter * value : vec2(0.0);
  uint at = plane * constants.plane + i;
  if (is_first != 0)
    store_vec4(constants.sum, at, vec4(term, 0.0, 0.0));
  else
    store_vec4(constants.sum, at, compensated_add(load_vec4(constants.sum, at), term));
}

#endif
