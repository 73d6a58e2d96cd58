#pragma once
// What the returns of a vector's pixels may be off by: errors_of of shaders/signal/demodulation.glsl, for
// pixels of one sample.

#include "engine/light/host/term_sums.h"

#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// As distance, and as relative amplitude.
struct Errors {
  Floats distance_m, amplitude;
};

// Of weights, as distance (weights_error_m there).
inline Floats weights_error_m(const shader::Frequency &frequency, float per_weight_m, const Floats &condition,
                              const Floats &largest, const Floats &weights) {
  const Floats square = larger(largest * largest - 1.0f, all(0.0f)), root_of = root(square + tiny);
  const Floats common_m = smaller(per_weight_m * condition, frequency.any_weight_m * root_of);
  return frequency.weight_error * common_m + per_weight_m * weights;
}

// `size`: of the return, as `terms` are.
inline Errors errors_of(const shader::Frequency &frequency, const Terms &terms, const Floats &size) {
  const Floats none = all(0.0f);
  const Floats condition = terms.light > 0.0f ? terms.light / size : none,
               weights = terms.weights > 0.0f ? terms.weights / size : none;
  const Floats relative = frequency.amplitude_per_condition * condition + frequency.per_weight * weights;
  const Floats grown =
      relative < 1.0f ? 1.0f / (1.0f - relative) : all(std::numeric_limits<float>::infinity());
  const Floats largest = condition * (1.0f + relative + 1e-6f) * grown;
  const float near_per_weight_m = frequency.near_per_weight_m < frequency.per_weight_m
                                      ? frequency.near_per_weight_m
                                      : frequency.per_weight_m;
  const Floats near_m = frequency.near_per_condition_m * condition +
                        weights_error_m(frequency, near_per_weight_m, condition, largest, weights);
  const Floats any_m = frequency.per_condition_m * condition +
                       weights_error_m(frequency, frequency.per_weight_m, condition, largest, weights);
  return {smaller(frequency.near_fixed_m + near_m * grown, frequency.fixed_m + any_m * grown),
          frequency.amplitude_fixed + relative};
}

// For the frame's claim: both negative where they are not within what was asked for, or no numbers.
inline Errors held(const shader::Frequency &frequency, const Errors &errors) {
  const Ints is_kept = (errors.distance_m <= frequency.limit_m) & (errors.amplitude <= frequency.amplitude_limit);
  const auto negated = [](const Floats &error) { return error > 0.0f ? -error : all(-1.0f); };
  return {is_kept ? errors.distance_m : negated(errors.distance_m),
          is_kept ? errors.amplitude : negated(errors.amplitude)};
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
