#pragma once
// What each pixel is off by, held against its own bound.

#include "engine/model/measurement.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace pmdsim::test {

inline void print_heading_of_bounds(const std::string &what) {
  fmt::print("\n{:30} {:>8} {:>12} {:>12}\n", what, "diodes", "largest um", "bound um");
}

// Fails where a pixel of `frame` is farther from `exact` than its bound allows, or the frame claims anything
// else than the largest bound; `exact` is in double. Prints a line of a table.
inline void check_kept_bounds(const std::string &name, const Measurement &frame, const Measurement &exact) {
  double largest_m = 0.0, bound_m = 0.0;
  for (std::size_t f = 0; f < frame.returns.size(); ++f)
    for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
      const Return &is = frame.returns[f], &should = exact.returns[f];
      if (!(should.amplitude[i] > 0.0f))
        continue;
      const double off_m = std::abs(double(is.distance_m[i]) - double(should.distance_m[i]));
      REQUIRE(off_m <= double(is.error_bound_m[i]) + 0x1p-24 * double(should.distance_m[i]));
      REQUIRE(double(is.error_bound_m[i]) <= *frame.accuracy.claimed_m);
      largest_m = std::max(largest_m, off_m);
      bound_m = std::max(bound_m, double(is.error_bound_m[i]));
    }
  CHECK(bound_m == Approx(*frame.accuracy.claimed_m));
  fmt::print("{:30} {:8} {:12.4f} {:12.4f}\n", name, frame.accuracy.diodes, 1e6 * largest_m, 1e6 * bound_m);
}

} // namespace pmdsim::test
