#include "engine/error_budget/plan.h"

#include "engine/error_budget/planned_bounds.h"
#include "engine/error_budget/planned_field.h"
#include "engine/error_budget/planned_groups.h"
#include "engine/error_budget/planned_precision.h"
#include "engine/light/radiation_laws.h"
#include "engine/light/source_windows.h"
#include "engine/model/error.h"
#include "engine/reduction/reduced_set.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// The share that the reduced set may take in each plan of what rounding leaves of the error asked for. The
// rest is for pixels whose returns cancel in part.
constexpr double share_of_reduction[frame_plans] = {0.5, 0.02, 0.0};
// A set that is off by more than half of rounding saves few diodes and claims much, so that it takes no more
// of the error than that, or this share.
constexpr double share_of_rounding = 0.5, least_share_of_reduction = 0.02;

// Pixels whose bound is so many times that of one in which nothing cancels are summed in double, wherever
// they can be. There are few of them, and the frame claims the worst bound of the others.
constexpr double largest_bound_in_float = 2.0;

double largest_growth(const FramePlan &plan) {
  double growth = 1.0;
  for (const SourceGroups *groups : {&plan.all, &plan.reduced, &plan.uniform_groups})
    growth = std::max(growth, growth_of(*groups));
  return growth;
}

// An upper bound of the condition, where all paths of a pixel differ so little that none cancels another, and
// nothing but light counts as terms (terms_of in shaders/light/sum.glsl); nothing where it may be more.
std::optional<double> largest_condition(const LightFacts &view, const FramePlan &plan) {
  const double wavenumber = view.modulation.largest_wavenumber_rad_m();
  const double half_rad = 0.5 * wavenumber * glm::distance(plan.extent.box.low_m, plan.extent.box.high_m);
  if (view.sensor.samples > 1 || plan.all.phased || half_rad > 1.0 ||
      view.modulation.waveform != shader::waveform_sine ||
      view.model.backscatter == shader::backscatter_lambert || view.model.pattern == shader::pattern_axial ||
      view.model.pattern == shader::pattern_any)
    return std::nullopt;
  return largest_growth(plan) / std::cos(half_rad);
}

// The errors that no pixel exceeds, if they are known before the frame.
struct SureBound {
  double distance_m, amplitude;
};

// As errors_of in shaders/signal/demodulation.glsl. Only of what no pixel has to know.
std::optional<SureBound> sure_bound(const LightFacts &view, const ErrorBound &bound, const FramePlan &plan) {
  const auto condition = largest_condition(view, plan);
  if (!condition || bound.terms_of_beam_edges > 0.0 || bound.beams.square > 0.0)
    return std::nullopt;
  const double relative = bound.amplitude_per_condition * *condition;
  if (!(relative < 1.0))
    return std::nullopt;
  const double per_condition_m =
      bound.per_condition_m + bound.weight_error * bound.even_part * bound.per_weight_m;
  return SureBound{bound.output_m + bound.fixed_m + per_condition_m * *condition / (1.0 - relative),
                   bound.amplitude_fixed + relative};
}

// Nothing where no bound is known before the frame, or that is beyond the limits: pixels are held against
// them one by one then.
void claim_what_is_sure(const LightFacts &view, const ErrorBound &bound, FramePlan &plan) {
  const auto sure = sure_bound(view, bound, plan);
  if (!sure || !(sure->distance_m <= bound.limit_m && sure->amplitude <= bound.amplitude_limit))
    return;
  plan.surely_kept = true;
  plan.claimed_m = sure->distance_m;
  plan.claimed_amplitude = sure->amplitude;
}

std::optional<ErrorBound> bound_beforehand(const LightFacts &view, const Accuracy &accuracy,
                                           const FramePlan &plan) {
  if (plan.all.polynomials.point_dimensions == 0)
    return std::nullopt;
  const PlannedSum sum{.precision = plan.precision, .samples = view.sensor.samples, .beforehand = true};
  const auto rounding = bound_of(view, plan.all, sum);
  if (!rounding)
    return std::nullopt;
  return error_bound_of(accuracy, *rounding, whole_light(view.lights), at_one_range(view, plan.all, sum));
}

ReducedLight light_within(const LightFacts &view, const Accuracy &accuracy, const RoundedSum &sum,
                          const TypicalLight &typical, double share) {
  if (share == 0.0 || view.modulation.waveform != shader::waveform_sine)
    return whole_light(view.lights);
  const RoundingBound &rounding = sum.bound;
  // In tables the error of a set grows as rounding does.
  const double growth = sum.groups.near_polynomials ? sum.groups.near_polynomials->growth : 1.0;
  const double rounding_m = std::min(rounding.distance_m(growth, typical.dimming),
                                     rounding.distance_m_at(growth * typical.condition, typical.dimming));
  if (rounding_m >= accuracy.max_error_m) // where samples are farther apart than most pixels' are
    return whole_light(view.lights);
  return reduce_diodes(
      view.lights, view.visible, view.backscatter, wavenumbers_rad_m(view.modulation),
      std::min(share * (accuracy.max_error_m - rounding_m),
               std::max(least_share_of_reduction * accuracy.max_error_m, share_of_rounding * rounding_m)) /
          growth,
      share * (accuracy.max_amplitude_error - rounding.amplitude(growth, typical.dimming)) / growth);
}

// Where nothing cancels, however dim beams are.
bool is_kept_where_none_cancel(const ErrorBound &bound) {
  return bound.nearest_m(1.0, bound.beams.darkest) <= bound.limit_m &&
         bound.amplitude_fixed + bound.amplitude_per_condition <= bound.amplitude_limit;
}

// One point in float, or four, whatever the precision of the others.
void plan_uniform_pixels(const LightFacts &view, const Accuracy &accuracy, const ReducedLight &light,
                         FramePlan &plan) {
  const bool in_float = accuracy.precision != Precision::fp64;
  if (in_float)
    plan.uniform_groups = groups_of(view, light.illuminators, Precision::fp32, 0.0, 1.0); // on the device
  // How much light a sample has is counted in these, also where pixels are only listed.
  plan.uniform_groups.diode_count = plan.all.diode_count;
  if (!in_float)
    return;
  const auto bound_at = [&](std::uint32_t side, double spread_m) -> std::optional<ErrorBound> {
    const PlannedSum sum{Precision::fp32, side, spread_m};
    const auto rounding = bound_of(view, plan.uniform_groups, sum);
    if (!rounding)
      return std::nullopt;
    const ErrorBound bound =
        error_bound_of(accuracy, *rounding, light, at_one_range(view, plan.uniform_groups, sum));
    return is_kept_where_none_cancel(bound) ? std::optional(bound) : std::nullopt;
  };
  plan.uniform_bound = bound_at(1, 0.0);
  if (plan.uniform_bound && view.sensor.samples > 1)
    plan.refined_bound = bound_at(2, point_spread_m);
}

// The largest of the bounds of what is summed in float.
double largest_m(const FramePlan &plan, double condition, double dimming) {
  double largest = 0.0;
  for (const auto *bound : {&plan.bound, &plan.bound_of_all, &plan.bound_beforehand})
    if (*bound)
      largest = std::max(largest, (*bound)->nearest_m(condition, dimming));
  return largest;
}

// For the pixels that float is not exact enough for. Bits that tell which sources reach a sample are in the
// order of the plan's sources.
void plan_precise_pixels(const LightFacts &view, const Accuracy &accuracy, const TypicalLight &typical,
                         FramePlan &plan) {
  if (plan.surely_kept || plan.precision == Precision::fp64 || accuracy.precision ||
      view.sensor.has_distortion() ||
      (view.modulation.lit && plan_windows(plan.all, view.window_bundles).size() > 1))
    return;
  SourceGroups groups =
      precise_groups(view.lights, view.visible, view.modulation.largest_wavenumber_rad_m(), plan.all);
  const PlannedSum sum{Precision::fp64, view.sensor.samples};
  const auto rounding = bound_of(view, groups, sum);
  if (!rounding)
    return;
  plan.precise = std::move(groups);
  plan.bound_of_precise =
      error_bound_of(accuracy, *rounding, whole_light(view.lights), at_one_range(view, *plan.precise, sum));
  // Diagrams take long to be looked up in double: only pixels beyond the budget try it.
  if (std::ranges::any_of(plan.all.positions,
                          [](const SourcePosition &place) { return place.law_error > 0.0; }))
    return;
  if (view.sensor.samples > 1 && view.modulation.lit) // all at once, many of them at edges: it takes too long
    return;
  const double usual_m = largest_m(plan, largest_growth(plan), typical.dimming_of_most);
  const auto lower = [&](std::optional<ErrorBound> &bound) {
    if (bound)
      bound->limit_m = std::min(bound->limit_m, largest_bound_in_float * usual_m);
  };
  lower(plan.bound);
  lower(plan.bound_of_all);
  lower(plan.bound_beforehand);
  lower(plan.uniform_bound);
  lower(plan.refined_bound);
}

FramePlan exact_plan(const LightFacts &view, const Accuracy &accuracy) {
  FramePlan plan;
  plan.precision = accuracy.precision.value_or(Precision::fp32);
  plan.all = plan.reduced = groups_of(view, view.lights, plan.precision);
  const ReducedLight light = whole_light(view.lights);
  plan.extent = {light.lights, pattern_slope(view.lights, view.visible)};
  const PlannedSum sum{.precision = plan.precision,
                       .samples = view.sensor.samples,
                       .knows_pixels = view.sensor.adaptive_samples};
  if (const auto rounding = bound_of(view, plan.all, sum)) {
    const ErrorBound bound = error_bound_of(accuracy, *rounding, light);
    if (view.sensor.adaptive_samples)
      plan.bound = plan.bound_of_all = bound;
    // Where samples adapt, pixels that may be beyond the bound are summed in full: nothing is claimed of
    // them.
    if (const auto sure = sure_bound(view, bound, plan); sure && !plan.bound) {
      plan.claimed_m = sure->distance_m;
      plan.claimed_amplitude = sure->amplitude;
    }
  }
  if (plan.bound && plan.precision == Precision::fp32)
    plan_uniform_pixels(view, accuracy, light, plan);
  return plan;
}

// The amplitude only where it is asked for.
std::string errors_text(double distance_m, double amplitude, const Accuracy &asked_for) {
  const std::string distance = fmt::format("{:.6g} mm", 1e3 * distance_m);
  return std::isfinite(asked_for.max_amplitude_error)
             ? fmt::format("{} and {:.3g} of the amplitude", distance, amplitude)
             : distance;
}

std::string limits_text(const Accuracy &asked_for) {
  return errors_text(asked_for.max_error_m, asked_for.max_amplitude_error, asked_for);
}

} // namespace

bool FramePlan::has_beams() const {
  return std::ranges::any_of(
      std::array{&bound, &bound_of_all, &bound_beforehand, &bound_of_precise, &uniform_bound, &refined_bound},
      [](const std::optional<ErrorBound> *of) { return *of && (*of)->beams.square > 0.0; });
}

FramePlan plan_frame(const LightFacts &view, const Accuracy &accuracy, std::uint32_t attempt) {
  if (accuracy.mode == Mode::exact)
    return exact_plan(view, accuracy);
  FramePlan plan;
  const TypicalLight typical =
      typical_light(view.lights, view.visible, view.modulation.largest_wavenumber_rad_m());
  RoundedSum sum = choose_precision(view, accuracy, typical, attempt);
  const ReducedLight light = light_within(view, accuracy, sum, typical, share_of_reduction[attempt]);
  plan.precision = sum.precision;
  plan.all = std::move(sum.groups);
  plan.reduced =
      groups_of(view, light.illuminators, plan.precision,
                tolerance_of(view, plan.precision, accuracy, share_of_series[attempt]), plan.all.near_growth);
  plan.reduced.diode_count = plan.all.diode_count; // how much light a sample has is counted in these
  plan.extent = {light.lights, pattern_slope(view.lights, view.visible)};
  const PlannedSum whole{plan.precision, view.sensor.samples};
  const auto of_all = at_one_range(view, plan.all, whole);
  plan.bound_of_all = error_bound_of(accuracy, sum.bound, whole_light(view.lights), of_all);
  if (const auto of_reduced = bound_of(view, plan.reduced, whole))
    plan.bound = error_bound_of(accuracy, *of_reduced, light, at_one_range(view, plan.reduced, whole));
  else
    plan.bound = error_bound_of(accuracy, sum.bound, light, of_all);
  if (accuracy.mode == Mode::automatic && attempt == 0 && plan.precision == Precision::fp32)
    plan.field = plan_field(view, plan.all, *plan.bound_of_all);
  plan.bound_beforehand = bound_beforehand(view, accuracy, plan);
  plan_uniform_pixels(view, accuracy, light, plan);
  ErrorBound worst = worse_of(*plan.bound, plan.uniform_bound.value_or(*plan.bound));
  if (plan.field)
    worst = worse_of(worst, plan.field->bound);
  if (plan.field || view.modulation.lit || view.model.backscatter != shader::backscatter_flat)
    worst = worse_of(worst, *plan.bound_of_all);
  if (plan.bound_beforehand)
    worst = worse_of(worst, *plan.bound_beforehand);
  claim_what_is_sure(view, worst, plan);
  plan_precise_pixels(view, accuracy, typical, plan);
  return plan;
}

std::optional<std::string> beyond_bound(const shader::BudgetViolations &violations,
                                        const Accuracy &asked_for) {
  if (violations.returns > 0)
    return fmt::format("{} returns of pixels cancel in part, or are weak beside what rounding does to them, "
                       "and may be off by up to {}; expected at most {}",
                       violations.returns,
                       errors_text(static_cast<double>(std::bit_cast<float>(violations.worst_m)),
                                   static_cast<double>(std::bit_cast<float>(violations.amplitude)),
                                   asked_for),
                       limits_text(asked_for));
  return std::nullopt;
}

std::optional<std::string> beyond_check(const AccuracyReport &found, const Accuracy &asked_for,
                                        double ambiguity_m) {
  const double found_m = found.found_m.value_or(0.0), amplitude = found.found_amplitude.value_or(0.0);
  // The distances that are compared are themselves rounded to float.
  const double rounding_m = 0x1p-24 * ambiguity_m;
  // Which pixels' amplitudes are not promised is not known one by one.
  const bool amplitude_holds = amplitude <= asked_for.max_amplitude_error + 0x1p-23 || found.unpromised > 0;
  if (found_m > asked_for.max_error_m + rounding_m || !amplitude_holds)
    return fmt::format("pixels evaluated exactly are off by up to {}; expected at most {}",
                       errors_text(found_m, amplitude, asked_for), limits_text(asked_for));
  return std::nullopt;
}

} // namespace pmdsim
