#include "engine/error_budget/typical_condition.h"

#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

namespace pmdsim {
namespace {

constexpr std::size_t most_places = 64;

// Of light that reaches the place at all.
double weight_of(const Diode &diode, const glm::dvec3 &to_place_m) {
  const double range_m = glm::length(to_place_m);
  const std::optional<LawSeries> law = law_series(diode.pattern);
  const double cosine = std::max(0.0, glm::dot(diode.axis, to_place_m) / range_m);
  const double pattern = law && law->order ? std::pow(cosine, *law->order) : 1.0;
  return diode.intensity_w_sr * pattern / (range_m * range_m);
}

// Nothing where no diode lights the place.
std::optional<double> condition_at(const glm::dvec3 &place_m, const std::vector<CameraIlluminator> &lights,
                                   double wavenumber_rad_m) {
  double sizes = 0.0;
  std::complex<double> sum;
  for (const CameraIlluminator &light : lights)
    for (const Diode &diode : light.diodes) {
      const glm::dvec3 to_place_m = place_m - diode.position_m;
      const double weight = weight_of(diode, to_place_m);
      sizes += weight;
      sum += std::polar(weight, wavenumber_rad_m * glm::length(to_place_m) + light.modulation_phase_rad);
    }
  return sizes > 0.0 ? std::optional(sizes / std::abs(sum)) : std::nullopt;
}

} // namespace

double typical_condition(const std::vector<CameraIlluminator> &lights, const std::vector<VisibleBox> &visible,
                         double wavenumber_rad_m) {
  std::vector<double> conditions;
  const std::size_t step = (visible.size() + most_places - 1) / most_places;
  for (std::size_t i = 0; i < visible.size(); i += step)
    if (const auto condition =
            condition_at(0.5 * (visible[i].low_m + visible[i].high_m), lights, wavenumber_rad_m))
      conditions.push_back(*condition);
  if (conditions.empty())
    return 1.0;
  const auto middle = conditions.begin() + static_cast<std::ptrdiff_t>(conditions.size() / 2);
  std::ranges::nth_element(conditions, middle);
  return *middle;
}

} // namespace pmdsim
