#version 460
// accumulate.comp where all samples are summed alike, each of one record: its point follows from its depth, and the backscatter
// joins in the resolve pass. Of lit walls that face all diodes one load and, of a frame's only run, one store a sample, which
// lavapipe does lane by lane.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/compensated.glsl"
#include "shaders/sampling/grid.glsl"
#include "shaders/view/meet.glsl"
#include "shaders/shared/constants.h"

layout(push_constant, std430) uniform Constants { PlainSumConstants constants; };
layout(constant_id = constant_is_only) const uint is_only = 0;
layout(constant_id = constant_general_chip) const uint general_chip = 0;
#define DIAGRAM_VALUES constants.diagrams
#include "shaders/light/moments.glsl"

ReferencePath load_point(uint i, LightRun run, out Point point) {
  uvec2 at = row_by_row(i, constants.grid.columns, constants.grid.inverse_columns);
  Real3 ray = ray_of(at, constants.grid, constants.chip, general_chip != 0);
  Real3 position = point_at_depth(ray, load_record_depth(constants.records, i));
  vec4 surface = vec4(0.0);
  if (backscatter_model != backscatter_flat) {
    // What only pads has no record.
    uint triangle = load_record_tag(constants.records, min(i, constants.samples - 1)).y;
    surface = load_vec4(constants.planes, 3 * triangle) * vec4(1.0, 1.0, 1.0, -1.0);
  }
  return see_point(position, surface, run, point);
}

void add_tone(uint t, uint i, float moment[moments], ReferencePath path, LightRun run) {
  vec2 value = tone_return(moment, path, run, Tones(constants.tones).at[t]);
  uint at = t * constants.plane + i;
  if (is_only != 0) {
    store_tag(constants.sum, at, floatBitsToUint(value));
  } else {
    // One pipeline for all runs: long ones take their time to compile.
    vec4 before = mix(load_vec4(constants.sum, at), vec4(0.0), bvec4(constants.is_first != 0));
    store_vec4(constants.sum, at, compensated_add(before, value));
  }
}

// More of them would take long to compile, and are seldom.
const uint unrolled_tones = 16;

void main() {
  uint i = gl_GlobalInvocationID.x;
  LightRun run = LightRuns(constants.run).at;
  Point point;
  ReferencePath path = load_point(i, run, point);
  float moment[moments];
  sum_run(i, point, run, constants.diodes, 0u, constants.blocks, moment);
  if (tones <= unrolled_tones) {
    [[unroll]] for (uint t = 0; t < tones; ++t)
      add_tone(t, i, moment, path, run);
  } else {
    for (uint t = 0; t < tones; ++t)
      add_tone(t, i, moment, path, run);
  }
}
