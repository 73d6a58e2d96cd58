#include "host/bench/linearity.h"

#include <limits>

namespace pmdsim {
namespace {

// The normal equations of fixed / ms + slope * size / ms = 1.
struct Sums {
  double aa = 0.0, ab = 0.0, bb = 0.0, a = 0.0, b = 0.0; // a = 1 / ms, b = size / ms
};

Sums sums_of(std::span<const SizeAndTime> points) {
  Sums sums;
  for (const auto &[size, ms] : points) {
    const double a = 1.0 / ms, b = size / ms;
    sums.aa += a * a, sums.ab += a * b, sums.bb += b * b, sums.a += a, sums.b += b;
  }
  return sums;
}

} // namespace

StraightLine straight_line(std::span<const SizeAndTime> points) {
  const auto [aa, ab, bb, a, b] = sums_of(points);
  const double determinant = aa * bb - ab * ab;
  if (determinant <= 1e-12 * aa * bb) // all of one size
    return {0.0, b / bb};
  const StraightLine line{(a * bb - b * ab) / determinant, (aa * b - ab * a) / determinant};
  if (line.fixed_ms < 0.0)
    return {0.0, b / bb};
  if (line.slope_ms < 0.0)
    return {a / aa, 0.0};
  return line;
}

std::vector<double> marginal_costs_ms(std::span<const SizeAndTime> points) {
  std::vector<double> costs_ms;
  for (std::size_t i = 0; i < points.size(); ++i)
    costs_ms.push_back(i == 0 ? std::numeric_limits<double>::quiet_NaN()
                              : (points[i].ms - points[i - 1].ms) / (points[i].size - points[i - 1].size));
  return costs_ms;
}

} // namespace pmdsim
