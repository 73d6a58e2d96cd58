#include "engine/passes/frame_plan.h"

#include "engine/error.h"
#include "engine/passes/diode_reduction.h"
#include "engine/passes/pattern_slope.h"
#include "engine/passes/rounding_bound.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

// Of what rounding leaves of the error asked for, how much the stand-ins may take in each plan. The rest is
// for pixels whose returns cancel in part.
constexpr double share_of_stand_ins[frame_plans] = {0.5, 0.02, 0.0};

double wavenumber_rad_m(double modulation_hz) {
  return 2.0 * std::numbers::pi * modulation_hz / speed_of_light_m_s;
}

Wavenumbers wavenumbers_of(const Signal &signal) {
  const auto [smallest, largest] = std::ranges::minmax(signal.modulation_hz);
  return {wavenumber_rad_m(smallest), wavenumber_rad_m(largest)};
}

std::optional<RoundingBound> bound_of(const LitView &view, const DiodeGroups &groups, Precision precision) {
  RoundingScope scope;
  scope.precision = precision;
  scope.samples = view.sensor.samples;
  scope.incidence_cosine = least_incidence_cosine(view.camera, groups, view.visible);
  scope.emission_cosine = least_emission_cosine(groups, view.visible);
  return rounding_bound(groups, view.visible, view.model, view.signal, scope);
}

bool is_within(const RoundingBound &bound, const Accuracy &accuracy) {
  return bound.distance_m(1.0) < accuracy.max_error_m && bound.amplitude(1.0) < accuracy.max_amplitude_error;
}

[[noreturn]] void refuse(const Accuracy &accuracy, const std::string &why) {
  throw Error(ExitCode::accuracy, fmt::format("a distance error of at most {:.6g} mm cannot be promised: {}",
                                              1e3 * accuracy.max_error_m, why));
}

// The cheapest precision from the `attempt`-th on that leaves something of the error asked for, with its
// bound.
std::pair<Precision, RoundingBound> choose_precision(const LitView &view, const DiodeGroups &groups,
                                                     const Accuracy &accuracy, std::uint32_t attempt) {
  std::optional<RoundingBound> bound;
  for (const Precision precision : {Precision::fp32, Precision::fp64}) {
    const Precision available = sum_precision(view.signal, precision);
    if (available != accuracy.precision.value_or(available))
      continue;
    if (precision == Precision::fp32 && attempt > 0 && !accuracy.precision)
      continue;
    bound = bound_of(view, groups, available);
    if (bound && is_within(*bound, accuracy))
      return {available, *bound};
  }
  refuse(accuracy, bound ? fmt::format("rounding alone may come to {:.6g} mm", 1e3 * bound->distance_m(1.0))
                         : "theory has no bound for diodes with measured diagrams");
}

Promise promise_of(const Accuracy &accuracy, const RoundingBound &rounding, const ReducedLight &light) {
  // A relative error of the sum below 10^-2 turns it by its arcsine.
  constexpr double of_arcsine = 1.0001;
  return {accuracy.max_error_m,
          rounding.fixed_m,
          of_arcsine * (rounding.per_condition_m + light.error_per_condition_m),
          accuracy.max_amplitude_error,
          rounding.amplitude_fixed,
          rounding.amplitude_per_condition + light.amplitude_error_per_condition};
}

} // namespace

} // namespace pmdsim
