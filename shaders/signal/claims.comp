#version 460
// Judges what the pixels of direct_pixels.comp may be off by, together: the frame's claim, the pixels that a later class sums
// again, or the returns that are beyond what was asked for. It is apart from the sum, as lavapipe takes its time for atomics
// where no lane has any to do, and an invocation takes many pixels.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/pixel_list.glsl"
#include "shaders/signal/violations.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { ClaimsConstants constants; };
layout(constant_id = constant_passes_on) const uint passes_on = 0;
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer ErrorsOf { vec2 at[]; };

vec2 load_errors(uint tone, uint pixel) { return ErrorsOf(constants.errors).at[tone * constants.plane + pixel]; }

// A pixel some of whose returns are not kept.
void settle(uint pixel) {
  bool passes = false;
  for (uint t = 0; t < constants.tones; ++t) {
    vec2 errors = load_errors(t, pixel);
    if (!(errors.x < 0.0))
      continue;
    passes = true;
    if (passes_on == 0)
      report_violation(constants.violations, Errors(-errors.x, -errors.y));
  }
  if (passes_on != 0 && passes)
    append_pixel(PixelLists(constants.later), pixel);
}

void main() {
  // Neighbours lie side by side in memory for the invocations, not for one of them.
  uint first = gl_WorkGroupID.x * workgroup_size * claims_per_invocation + gl_LocalInvocationID.x;
  Errors kept = Errors(0.0, 0.0);
  bool all_kept = true;
  for (uint t = 0; t < constants.tones; ++t)
    for (uint k = 0; k < claims_per_invocation; ++k) {
      vec2 errors = load_errors(t, min(first + k * workgroup_size, constants.pixels - 1u));
      bool is_kept = !(errors.x < 0.0);
      all_kept = all_kept && is_kept;
      kept = Errors(max(kept.distance_m, is_kept ? errors.x : 0.0), max(kept.amplitude, is_kept ? errors.y : 0.0));
    }
  report_kept(constants.violations, kept);
  for (uint k = 0; k < claims_per_invocation && !all_kept; ++k)
    if (first + k * workgroup_size < constants.pixels)
      settle(first + k * workgroup_size);
}
