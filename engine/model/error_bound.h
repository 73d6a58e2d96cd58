#pragma once
// What is promised of every pixel: an error within the limit. It is off by fixed + per_condition * condition
// at most, the condition being sum of |terms| / |sum| over its samples and diodes.

namespace pmdsim {

struct Promise {
  double limit_m, fixed_m, per_condition_m;                         // of distance, wrapped
  double amplitude_limit, amplitude_fixed, amplitude_per_condition; // relative
  // A diode's weight that is off by its own size is as bad as this many times its term in the condition.
  double terms_per_weight_error = 0.0;
  // Where beams may end in view: the same of what rounding does to a cosine to a diode's axis, of order 1.
  double terms_of_rims = 0.0;
};

} // namespace pmdsim
