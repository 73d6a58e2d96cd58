#pragma once
// What the returns of a vector's pixels may be off by: errors_of of shaders/signal/demodulation.glsl, for
// pixels of one sample.

#include "engine/light/host/term_sums.h"

#include <algorithm>
#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// As distance, and as relative amplitude.
struct Errors {
  Floats distance_m, amplitude;
};

// Inverses and roots of bounds are a hair too large, not too small.
constexpr float at_least = 1.000002f;
constexpr float smallest = 1e-37f; // that has an inverse

// Of weights, as distance (weights_error_m there). `even_part`: of per_weight_m. `turning`: sqrt(condition^2
// - 1), at the most. `of_beams`: the root of the mean square of the errors within beams. `turned`: the errors
// of each run times how far they turn the return at the most, over its size.
inline Floats weights_error_m(const shader::Frequency &frequency, float per_weight_m, float even_part,
                              const Floats &condition, const Floats &turning, const Floats &weights,
                              const Floats &of_beams, const Terms &turned) {
  const float any_m = frequency.any_weight_m;
  const Floats most_m = per_weight_m * condition, turning_m = any_m * turning;
  const Floats common_m = smaller(smaller(even_part * most_m, turning_m), any_m * turned.light);
  const Floats of_beams_m =
      of_beams > 0.0f ? smaller(of_beams * smaller(most_m, turning_m), any_m * turned.beams) : all(0.0f);
  return frequency.weight_error * common_m + of_beams_m +
         smaller(per_weight_m * weights, any_m * turned.weights);
}

// A pixel's only sample is at one range, for which the bound is mostly the tighter one.
inline bool is_tighter_at_one_range(const shader::Frequency &frequency) {
  return frequency.near_fixed_m <= frequency.fixed_m &&
         frequency.near_per_condition_m <= frequency.per_condition_m &&
         frequency.near_per_weight_m <= frequency.per_weight_m;
}

// `size`: of the return, as `terms` are, and `turned` (weights_error_m), which are infinite where they are
// not known. `distance_m`: the return's, or 0.
inline Errors errors_of(const shader::Frequency &frequency, const Terms &terms, const Floats &size,
                        const Floats &distance_m, const Terms &turned) {
  const Floats none = all(0.0f), infinite = all(std::numeric_limits<float>::infinity());
  const Floats inverse_size = size > smallest ? at_least * inverse(size) : infinite;
  const auto over = [&](const Floats &part) { return part > 0.0f ? part * inverse_size : none; };
  const Floats condition = over(terms.light), weights = over(terms.weights);
  const Floats of_beams =
      ((terms.light > 0.0f) & (terms.beams > 0.0f)) ? at_least * root(terms.beams / terms.light) : none;
  const Floats relative = frequency.amplitude_per_condition * condition +
                          frequency.per_weight * (weights + (of_beams > 0.0f ? of_beams * condition : none));
  const Floats grown = relative < 1.0f ? at_least * inverse(1.0f - relative) : infinite;
  // As large as has a square: what grows without end is unbounded by `grown` itself.
  const Floats largest = smaller(condition * (1.0f + relative + 1e-6f) * grown, all(1e18f)),
               turning = at_least * root(larger(largest * largest - 1.0f, all(tiny)));
  const Terms over_size{over(turned.light), over(turned.weights), over(turned.beams)};
  const auto bound_m = [&](float fixed_m, float per_condition_m, float per_weight_m, float even_part) {
    const Floats growing_m =
        per_condition_m * condition +
        weights_error_m(frequency, per_weight_m, even_part, condition, turning, weights, of_beams, over_size);
    return fixed_m + growing_m * grown;
  };
  Floats error_m =
      bound_m(frequency.near_fixed_m, frequency.near_per_condition_m,
              std::min(frequency.near_per_weight_m, frequency.per_weight_m), frequency.near_even_part);
  if (!is_tighter_at_one_range(frequency))
    error_m = smaller(error_m, bound_m(frequency.fixed_m, frequency.per_condition_m, frequency.per_weight_m,
                                       frequency.even_part));
  constexpr float output_rounding = 0x1p-24f; // of the distance to float
  return {output_rounding * distance_m + error_m, frequency.amplitude_fixed + relative};
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
