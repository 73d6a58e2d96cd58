#include "engine/correction/range_noise.h"

#include "engine/correction/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

// The value that so many of all do not exceed.
double quantile(std::vector<double> values, double share) {
  if (values.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

// What `value_of` says of the pixels that have all eight neighbours.
template <class ValueOf>
std::vector<double> inside(const RangeImage &image, ValueOf value_of) {
  std::vector<double> values;
  for (int row = 1; row + 1 < static_cast<int>(image.resolution.y); ++row)
    for (int column = 1; column + 1 < static_cast<int>(image.resolution.x); ++column) {
      if (!std::isfinite(image.range_m[static_cast<std::size_t>(row) * image.resolution.x +
                                       static_cast<std::size_t>(column)]))
        continue;
      const Neighbourhood around(image, {column, row});
      int count = 0;
      around.visit({-1, 1, -1, 1}, [&](int, int) { ++count; });
      if (count == 9)
        values.push_back(value_of(around));
    }
  return values;
}

} // namespace

double noise_of(const RangeImage &image) {
  const auto odd_parts = inside(image, [](const Neighbourhood &around) {
    const std::optional<FittedPlane> plane = fitted_plane(around, {-1, 1, -1, 1});
    if (!plane)
      return std::numeric_limits<double>::max();
    double squares = 0.0;
    for (const auto &[column, row] :
         {std::pair(-1, -1), std::pair(0, -1), std::pair(1, -1), std::pair(-1, 0)}) {
      const double odd = 0.5 * (residual_m(around.point(column, row), *plane) -
                                residual_m(around.point(-column, -row), *plane));
      squares += odd * odd;
    }
    return squares; // of two degrees of freedom, each with half of the variance of a range
  });
  constexpr double share = 0.2; // of an exponential distribution
  return std::sqrt(quantile(odd_parts, share) / -std::log(1.0 - share));
}

double spacing_of(const RangeImage &image) {
  const auto spacings_m = inside(image, [](const Neighbourhood &around) {
    const glm::dvec3 across = 0.5 * (around.direction(1, 0) - around.direction(-1, 0)),
                     down = 0.5 * (around.direction(0, 1) - around.direction(0, -1));
    return around.range_m(0, 0) * std::sqrt(glm::length(glm::cross(across, down)));
  });
  return quantile(spacings_m, 0.5);
}

std::uint32_t fit_pixels_for(double noise_m, double spacing_m) {
  constexpr double wanted_rad = 2e-2;
  constexpr std::uint32_t most = 8;
  std::uint32_t n = 1;
  const auto uncertainty_rad = [&] {
    const double side = 2.0 * n + 1.0; // the sum of squares of either offset is side^2 n (n + 1) / 3
    return noise_m / spacing_m * std::sqrt(2.0 * 3.0 / (side * side * n * (n + 1.0)));
  };
  while (n < most && uncertainty_rad() > wanted_rad)
    ++n;
  return n;
}

} // namespace pmdsim
