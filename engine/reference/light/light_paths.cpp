#include "engine/reference/light/light_paths.h"

#include "engine/reference/light/radiation_laws.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace pmdsim::reference {

namespace {

double backscatter_per_sr(Backscatter backscatter, double reflectivity, double cos_incidence) {
  if (cos_incidence <= 0)
    return 0.0;
  return backscatter == Backscatter::constant ? reflectivity
                                              : reflectivity * std::numbers::inv_pi * cos_incidence;
}

} // namespace

LightReturn light_return(const SurfacePoint &point, const Diode &diode, Backscatter backscatter) {
  const glm::dvec3 to_diode_m = diode.position_m - point.position_m;
  const double range_m = glm::length(to_diode_m);
  const double cos_incidence = glm::dot(point.normal, to_diode_m) / range_m;
  const double returned_w_sr2 = point.lens_gain *
                                backscatter_per_sr(backscatter, point.reflectivity, cos_incidence) *
                                diode.intensity_w_sr * radiation(diode, to_diode_m, range_m);
  return {range_m, returned_w_sr2 / (range_m * range_m)};
}

std::vector<LightPath> light_paths(const SurfacePoint &point, const std::vector<Light> &lights,
                                   const DiodeSet &reached, Backscatter backscatter) {
  std::vector<LightPath> paths;
  paths.reserve(reached.count());
  const double lens_range_m = glm::length(point.position_m);
  std::size_t index = 0;
  for (const Light &light : lights)
    for (const Diode &diode : light.diodes) {
      if (!reached.has(index++))
        continue;
      const auto [diode_range_m, weight_w_m2_sr] = light_return(point, diode, backscatter);
      if (weight_w_m2_sr != 0)
        paths.push_back(
            {diode_range_m + lens_range_m, weight_w_m2_sr, light.phase_turns, light.modulation_depth});
    }
  return paths;
}

} // namespace pmdsim::reference
