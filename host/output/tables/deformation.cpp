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

double centre_mm(std::span<const float> deformation_mm, const glm::uvec2 &resolution) {
  Mean mean;
  for (std::size_t row = (resolution.y - 1) / 2; row <= resolution.y / 2; ++row)
    for (std::size_t column = (resolution.x - 1) / 2; column <= resolution.x / 2; ++column)
      if (const float value = deformation_mm[row * resolution.x + column]; !std::isnan(value))
        mean.add(static_cast<double>(value));
  return mean.value();
}

} // namespace

std::vector<float> deformation_mm(std::span<const float> bistatic_distance_m,
                                  std::span<const float> monostatic_distance_m, double ambiguity_m) {
  std::vector<float> deformation(bistatic_distance_m.size());
  std::transform(bistatic_distance_m.begin(), bistatic_distance_m.end(), monostatic_distance_m.begin(),
                 deformation.begin(), [&](float bistatic_m, float monostatic_m) {
                   const double difference_m =
                       static_cast<double>(bistatic_m) - static_cast<double>(monostatic_m);
                   return static_cast<float>(1e3 * wrapped(difference_m, ambiguity_m));
                 });
  return deformation;
}

DeformationStatistics statistics_of(std::span<const float> deformation_mm, const glm::uvec2 &resolution) {
  Mean mean, mean_square;
  double min_mm = std::numeric_limits<double>::quiet_NaN(), max_mm = min_mm;
  for (const float pixel_mm : deformation_mm) {
    if (std::isnan(pixel_mm))
      continue;
    const double value_mm = static_cast<double>(pixel_mm);
    mean.add(value_mm);
    mean_square.add(value_mm * value_mm);
    min_mm = std::fmin(min_mm, value_mm);
    max_mm = std::fmax(max_mm, value_mm);
  }
  return {mean.value(), min_mm, max_mm, std::sqrt(mean_square.value()),
          centre_mm(deformation_mm, resolution)};
}

} // namespace pmdsim
