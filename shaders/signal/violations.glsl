// The errors that pixels may have, and their account: the frame's claim, and how many returns do not keep what was asked for.
#ifndef PMDSIM_VIOLATIONS_GLSL
#define PMDSIM_VIOLATIONS_GLSL

#include "shaders/shared/constants.h"

layout(constant_id = constant_reports_kept) const uint reports_kept = 0;

// Errors as distance and as relative amplitude. Nothing where there is no light at all.
struct Errors {
  float distance_m, amplitude;
};

layout(buffer_reference, std430, buffer_reference_align = 16) buffer ViolationWords {
  uint returns, worst_m, amplitude, kept_m, kept_amplitude;
};

void report_violation(uvec2 violations, Errors errors) {
  ViolationWords words = ViolationWords(violations);
  atomicAdd(words.returns, 1u);
  atomicMax(words.worst_m, floatBitsToUint(errors.distance_m));
  atomicMax(words.amplitude, floatBitsToUint(errors.amplitude));
}

// Few pixels are the worst so far, and looking is cheaper than an atomic.
void report_kept(uvec2 violations, Errors errors) {
  if (reports_kept == 0)
    return;
  ViolationWords words = ViolationWords(violations);
  uint distance_m = floatBitsToUint(errors.distance_m), amplitude = floatBitsToUint(errors.amplitude);
  if (distance_m > words.kept_m)
    atomicMax(words.kept_m, distance_m);
  if (amplitude > words.kept_amplitude)
    atomicMax(words.kept_amplitude, amplitude);
}

#endif
