#include "engine/error_budget/typical_light.h"

#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

namespace pmdsim {
namespace {

constexpr std::size_t most_places = 64;
constexpr double most = 0.9;

double beam_at(const Diode &diode, const glm::dvec3 &to_place_m) {
  const std::optional<LawSeries> law = law_series(diode.pattern);
  const double cosine = std::max(0.0, glm::dot(diode.axis, glm::normalize(to_place_m)));
  return law && law->order ? std::pow(cosine, *law->order) : 1.0;
}

struct PlaceLight {
  double condition, dimming;
};

// Nothing where no diode lights the place.
std::optional<PlaceLight> light_at(const glm::dvec3 &place_m, const std::vector<CameraIlluminator> &lights,
                                   double wavenumber_rad_m) {
  double all = 0.0, sizes = 0.0;
  std::complex<double> sum;
  for (const CameraIlluminator &light : lights)
    for (const Diode &diode : light.diodes) {
      const glm::dvec3 to_place_m = place_m - diode.position_m;
      const double range_m = glm::length(to_place_m), axial = diode.intensity_w_sr / (range_m * range_m);
      const double weight = axial * beam_at(diode, to_place_m);
      all += axial;
      sizes += weight;
      sum += std::polar(weight, wavenumber_rad_m * range_m + light.modulation_phase_rad);
    }
  if (!(sizes > 0.0))
    return std::nullopt;
  return PlaceLight{sizes / std::abs(sum), std::log(all / sizes)};
}

// The value that `part` of them are below.
double quantile(std::vector<double> values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size()));
  std::ranges::nth_element(values, at);
  return *at;
}

} // namespace

TypicalLight typical_light_at(const std::vector<glm::dvec3> &places_m,
                              const std::vector<CameraIlluminator> &lights, double wavenumber_rad_m) {
  std::vector<double> conditions, dimmings;
  const std::size_t step = (places_m.size() + most_places - 1) / most_places;
  for (std::size_t i = 0; i < places_m.size(); i += step)
    if (const auto light = light_at(places_m[i], lights, wavenumber_rad_m)) {
      conditions.push_back(light->condition);
      dimmings.push_back(light->dimming);
    }
  if (conditions.empty())
    return {};
  return {quantile(conditions, 0.5), quantile(dimmings, 0.5), quantile(dimmings, most)};
}

TypicalLight typical_light(const std::vector<CameraIlluminator> &lights,
                           const std::vector<VisibleBox> &visible, double wavenumber_rad_m) {
  std::vector<glm::dvec3> middles_m;
  for (const VisibleBox &box : visible)
    middles_m.push_back(0.5 * (box.low_m + box.high_m));
  return typical_light_at(middles_m, lights, wavenumber_rad_m);
}

} // namespace pmdsim
