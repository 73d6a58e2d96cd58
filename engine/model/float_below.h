#pragma once
// The end of half-open intervals in float.

#include <cmath>

namespace pmdsim {

// The largest float below a value above 0.
inline float largest_float_below(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value ? nearest : std::nextafter(nearest, 0.0f);
}

} // namespace pmdsim
