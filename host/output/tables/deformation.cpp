#include "host/output/tables/deformation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// To (-period/2, +period/2].
double wrapped(double value, double period) { return value - period * std::ceil(value / period - 0.5); }

struct Mean {
  double sum = 0.0, count = 0.0;

  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return sum / count; } // NaN for no value at all
};

double centre_mm(std::span<const double> deformation_mm, const glm::uvec2 &resolution) {
  Mean mean;
  for (std::size_t row = (resolution.y - 1) / 2; row <= resolution.y / 2; ++row)
    for (std::size_t column = (resolution.x - 1) / 2; column <= resolution.x / 2; ++column)
      if (const double value_mm = deformation_mm[row * resolution.x + column]; !std::isnan(value_mm))
        mean.add(value_mm);
  return mean.value();
}

} // namespace

std::vector<double> deformation_mm(std::span<const double> bistatic_distance_m,
                                   std::span<const double> monostatic_distance_m, double ambiguity_m) {
  std::vector<double> deformation(bistatic_distance_m.size());
  std::transform(bistatic_distance_m.begin(), bistatic_distance_m.end(), monostatic_distance_m.begin(),
                 deformation.begin(), [&](double bistatic_m, double monostatic_m) {
                   return 1e3 * wrapped(bistatic_m - monostatic_m, ambiguity_m);
                 });
  return deformation;
}

DeformationStatistics statistics_of(std::span<const double> deformation_mm, const glm::uvec2 &resolution) {
  Mean mean, mean_square;
  double min_mm = std::numeric_limits<double>::quiet_NaN(), max_mm = min_mm;
  for (const double value_mm : deformation_mm) {
    if (std::isnan(value_mm))
      continue;
    mean.add(value_mm);
    mean_square.add(value_mm * value_mm);
    min_mm = std::fmin(min_mm, value_mm);
    max_mm = std::fmax(max_mm, value_mm);
  }
  Mean varying_square;
  for (const double value_mm : deformation_mm)
    if (!std::isnan(value_mm))
      varying_square.add((value_mm - mean.value()) * (value_mm - mean.value()));
  return {mean.value(),
          min_mm,
          max_mm,
          std::sqrt(mean_square.value()),
          centre_mm(deformation_mm, resolution),
          std::sqrt(varying_square.value())};
}

} // namespace pmdsim
