#pragma once
// A running sum of weighted values and of their squares. A value that is not a number is left out.

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {

struct Moments {
  double count = 0.0, sum = 0.0, squares = 0.0; // count: of weights

  void add(double value, double weight = 1.0) {
    if (std::isnan(value))
      return;
    count += weight;
    sum += weight * value;
    squares += weight * value * value;
  }
  double mean() const { return sum / count; }
  double mean_square() const { return squares / count; }
  // Of the values themselves.
  double variance() const { return std::max(0.0, mean_square() - mean() * mean()); }
  // Estimated, of what values of weight 1 are a sample of; not a number for fewer than two.
  double sample_variance() const {
    return count > 1.0 ? std::max(0.0, squares - sum * sum / count) / (count - 1.0)
                       : std::numeric_limits<double>::quiet_NaN();
  }
};

} // namespace pmdsim
