#include "engine/error_budget/planned_precision.h"

#include "engine/error_budget/planned_bounds.h"
#include "engine/error_budget/planned_groups.h"
#include "engine/light/radiation_laws.h"
#include "engine/model/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// Rounding at which float is chosen by what most pixels' returns cancel.
constexpr double widest_typical_m = 10e-6;
// The share of the error that tables may take in place of roots; and the least growth that they are worth.
constexpr double share_of_tables = 0.9, least_near_growth = 1.5;

bool is_within(const RoundingBound &bound, const Accuracy &accuracy, double condition, double dimming) {
  return bound.distance_m(condition, dimming) < accuracy.max_error_m &&
         bound.amplitude(condition, dimming) < accuracy.max_amplitude_error;
}

// Where pixels have that condition themselves. Wider bounds are many times what float is off by, so that the
// tight ones of double are worth its time.
bool is_mostly_within(const RoundingBound &bound, const Accuracy &accuracy, double condition,
                      double dimming) {
  return bound.distance_m_at(condition, dimming) < std::min(accuracy.max_error_m, widest_typical_m) &&
         bound.amplitude(condition, dimming) < accuracy.max_amplitude_error;
}

[[noreturn]] void refuse(const Accuracy &accuracy, const std::string &why) {
  throw Error(ExitCode::accuracy, fmt::format("a distance error of at most {:.6g} mm cannot be promised: {}",
                                              1e3 * accuracy.max_error_m, why));
}

[[noreturn]] void refuse(const Accuracy &accuracy, const RoundingBound &bound) {
  const double error_m = bound.distance_m(1.0, bound.beams.darkest);
  if (error_m >= accuracy.max_error_m)
    refuse(accuracy, fmt::format("rounding alone may come to {:.6g} mm", 1e3 * error_m));
  throw Error(
      ExitCode::accuracy,
      fmt::format("a relative amplitude error of at most {:.3g} cannot be promised: rounding alone may "
                  "come to {:.3g}",
                  accuracy.max_amplitude_error, bound.amplitude(1.0, bound.beams.darkest)));
}

const char *why_unbounded(const std::vector<CameraIlluminator> &lights) {
  DiagramTables tables;
  for (const CameraIlluminator &illuminator : lights)
    for (const Diode &diode : illuminator.diodes)
      if (!std::isfinite(law_error(diode.pattern, tables, 0.0)))
        return law_of(diode.pattern).unbounded;
  return "";
}

// How much rounding may grow in tables, however dim beams are.
double growth_within(const LightFacts &view, const Accuracy &accuracy, const SourceGroups &by_tables) {
  const auto bound = bound_of(view, by_tables, {Precision::fp32, view.sensor.samples});
  if (!bound)
    return 1.0;
  const double fixed_m = bound->distance_m(0.0), fixed = bound->amplitude(0.0);
  const double dimming = bound->beams.darkest;
  return share_of_tables *
         std::min((accuracy.max_error_m - fixed_m) / (bound->distance_m(1.0, dimming) - fixed_m),
                  (accuracy.max_amplitude_error - fixed) / (bound->amplitude(1.0, dimming) - fixed));
}

// By tables in place of roots, as far as those have room; but mixed and narrow beams by roots, as tables
// would let their claims grow two- to threefold.
SourceGroups groups_for(const LightFacts &view, const Accuracy &accuracy, Precision precision,
                        std::uint32_t attempt) {
  const double tolerance = tolerance_of(view, precision, accuracy, share_of_series[attempt]);
  const bool by_roots = view.model.pattern == shader::pattern_general;
  SourceGroups groups =
      groups_of(view, view.lights, precision, tolerance, by_roots ? 1.0 : largest_near_growth);
  if (!groups.near_polynomials)
    return groups;
  const double within = growth_within(view, accuracy, groups);
  if (within >= growth_of(groups))
    return groups;
  return groups_of(view, view.lights, precision, tolerance, within > least_near_growth ? within : 1.0);
}

} // namespace

RoundedSum choose_precision(const LightFacts &view, const Accuracy &accuracy, const TypicalLight &typical,
                            std::uint32_t attempt) {
  // With one sample a pixel, near pixels may pass to a class in double; with several, that takes too long.
  // Where shadows fall on several, all are summed at once, and pixels at edges, whose samples are apart,
  // may pass.
  const bool several = view.sensor.samples > 1;
  std::optional<RoundingBound> last;
  const Precision first = attempt == 0 ? Precision::fp32 : Precision::fp64;
  for (const Precision precision :
       {accuracy.precision.value_or(first), accuracy.precision.value_or(Precision::fp64)}) {
    SourceGroups groups = groups_for(view, accuracy, precision, attempt);
    const PlannedSum sum{precision, view.sensor.samples};
    const auto bound = bound_of(view, groups, sum);
    const auto usual = several && view.modulation.lit ? at_one_range(view, groups, sum) : bound;
    const double condition = several ? groups.polynomials.growth : 1.0;
    if (bound && (is_within(usual.value_or(*bound), accuracy, condition, bound->beams.darkest) ||
                  is_mostly_within(usual.value_or(*bound), accuracy, condition * typical.condition,
                                   several ? bound->beams.darkest : typical.dimming)))
      return {precision, std::move(groups), *bound};
    last = bound;
  }
  if (last)
    refuse(accuracy, *last);
  refuse(accuracy, why_unbounded(view.lights));
}

} // namespace pmdsim
