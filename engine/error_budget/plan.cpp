#include "engine/error_budget/plan.h"

#include "engine/error_budget/planned_groups.h"
#include "engine/error_budget/rounding_bound.h"
#include "engine/error_budget/typical_condition.h"
#include "engine/light/radiation_laws.h"
#include "engine/light/source_windows.h"
#include "engine/model/error.h"
#include "engine/reduction/reduced_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {
namespace {

// The share that the reduced set may take in each plan of what rounding leaves of the error asked for. The
// rest is for pixels whose returns cancel in part.
constexpr double share_of_reduction[frame_plans] = {0.5, 0.02, 0.0};
// The share that series of fewer terms may take in each plan.
constexpr double share_of_series[frame_plans] = {0.03, 0.006, 0.0};
// Rounding at which float is chosen by what most pixels' returns cancel.
constexpr double widest_typical_m = 10e-6;
// The share that rounding may take where high powers are taken by tables.
constexpr double share_of_tables = 0.25;
// A set that is off by more than rounding saves few diodes and claims much, so that it takes no more of the
// error than rounding does, or this share.
constexpr double least_share_of_reduction = 0.02;

// Pixels whose bound is so many times that of one in which nothing cancels are summed in double, wherever
// they can be. There are few of them, and the frame claims the worst bound of the others.
constexpr double largest_bound_in_float = 2.0;

// Relative errors: one rounding; those of paint, texture and vignetting.
constexpr double plain_backscatter_error = 0x1p-24, painted_backscatter_error = 0x1p-21;

// An upper bound of a pixel's angle, seen from the lens.
double pixel_rad(const Sensor &sensor) {
  if (sensor.has_distortion() || !sensor.chip.is_nominal())
    return std::numeric_limits<double>::infinity();
  return glm::length(sensor.pixel_pitch_m * sensor.fill_factor) / sensor.image_distance_m();
}

std::optional<RoundingBound> bound_of(const LightFacts &view, const SourceGroups &groups, Precision precision,
                                      std::uint32_t samples,
                                      std::optional<double> sample_spread_m = std::nullopt,
                                      bool beforehand = false) {
  RoundingScope scope;
  scope.beforehand = beforehand;
  scope.sample_spread_m = sample_spread_m;
  scope.precision = precision;
  scope.samples = samples;
  scope.pixel_rad = pixel_rad(view.sensor);
  scope.incidence_cosine = 1.0; // where light grazes a surface, the pixel's terms have it
  scope.emission_cosine = least_emission_cosine(groups, view.visible);
  scope.beam_edges_are_terms = scope.emission_cosine < beam_cosine;
  scope.backscatter_error = view.painted || view.sensor.vignetting != Vignetting::none
                                ? painted_backscatter_error
                                : plain_backscatter_error;
  return rounding_bound(groups, view.visible, view.model, view.modulation, scope);
}

// The same for pixels whose samples are at one range; nothing where there is only one sample.
std::optional<RoundingBound> at_one_range(const LightFacts &view, const SourceGroups &groups,
                                          Precision precision, std::uint32_t samples,
                                          bool beforehand = false) {
  return samples > 1 ? bound_of(view, groups, precision, samples, 0.0, beforehand) : std::nullopt;
}

bool is_within(const RoundingBound &bound, const Accuracy &accuracy, double condition) {
  return bound.distance_m(condition) < accuracy.max_error_m &&
         bound.amplitude(condition) < accuracy.max_amplitude_error;
}

// Where pixels have that condition themselves. Wider bounds are many times what float is off by, so that the
// tight ones of double are worth its time.
bool is_mostly_within(const RoundingBound &bound, const Accuracy &accuracy, double condition) {
  return bound.distance_m_at(condition) < std::min(accuracy.max_error_m, widest_typical_m) &&
         bound.amplitude(condition) < accuracy.max_amplitude_error;
}

[[noreturn]] void refuse(const Accuracy &accuracy, const std::string &why) {
  throw Error(ExitCode::accuracy, fmt::format("a distance error of at most {:.6g} mm cannot be promised: {}",
                                              1e3 * accuracy.max_error_m, why));
}

[[noreturn]] void refuse(const Accuracy &accuracy, const RoundingBound &bound) {
  if (bound.distance_m(1.0) >= accuracy.max_error_m)
    refuse(accuracy, fmt::format("rounding alone may come to {:.6g} mm", 1e3 * bound.distance_m(1.0)));
  throw Error(
      ExitCode::accuracy,
      fmt::format("a relative amplitude error of at most {:.3g} cannot be promised: rounding alone may "
                  "come to {:.3g}",
                  accuracy.max_amplitude_error, bound.amplitude(1.0)));
}

// All diodes as they are summed in a precision, and what rounding may do to that.
struct RoundedSum {
  Precision precision;
  SourceGroups groups;
  RoundingBound bound;
};

const char *why_unbounded(const std::vector<CameraIlluminator> &lights) {
  DiagramTables tables;
  for (const CameraIlluminator &illuminator : lights)
    for (const Diode &diode : illuminator.diodes)
      if (!std::isfinite(law_error(diode.pattern, tables, 0.0)))
        return law_of(diode.pattern).unbounded;
  return "";
}

// In float, high powers by tables; nothing where there are none, or where rounding might then take much of
// the error.
std::optional<RoundedSum> sum_by_tables(const LightFacts &view, const Accuracy &accuracy,
                                        std::uint32_t attempt) {
  constexpr Precision precision = Precision::fp32;
  if (!has_high_powers(view) || accuracy.precision.value_or(precision) != precision)
    return std::nullopt;
  SourceGroups groups =
      groups_of(view, view.lights, precision,
                tolerance_of(view, precision, accuracy, share_of_series[attempt]), HighPowers::by_tables);
  const auto bound = bound_of(view, groups, precision, view.sensor.samples);
  Accuracy part = accuracy;
  part.max_error_m *= share_of_tables;
  part.max_amplitude_error *= share_of_tables;
  if (!groups.near_polynomials || !bound || !is_within(*bound, part, growth_of(groups)))
    return std::nullopt;
  return RoundedSum{precision, std::move(groups), *bound};
}

// In the cheapest precision from the `attempt`-th plan on that leaves something of the error asked for.
RoundedSum choose_precision(const LightFacts &view, const Accuracy &accuracy, double typical,
                            std::uint32_t attempt) {
  std::optional<RoundingBound> last;
  const Precision first = attempt == 0 ? Precision::fp32 : Precision::fp64;
  if (attempt == 0)
    if (auto sum = sum_by_tables(view, accuracy, attempt))
      return std::move(*sum);
  for (const Precision precision :
       {accuracy.precision.value_or(first), accuracy.precision.value_or(Precision::fp64)}) {
    SourceGroups groups = groups_of(view, view.lights, precision,
                                    tolerance_of(view, precision, accuracy, share_of_series[attempt]));
    const auto bound = bound_of(view, groups, precision, view.sensor.samples);
    // With one sample a pixel, near pixels may pass to a class in double; with several, that takes too long.
    // Where shadows fall on several, all are summed at once, and pixels at edges, whose samples are apart,
    // may pass.
    const bool several = view.sensor.samples > 1;
    const auto usual =
        several && view.modulation.lit ? at_one_range(view, groups, precision, view.sensor.samples) : bound;
    const double condition = several ? groups.polynomials.growth : 1.0;
    if (bound && (is_within(usual.value_or(*bound), accuracy, condition) ||
                  is_mostly_within(usual.value_or(*bound), accuracy, condition * typical)))
      return {precision, std::move(groups), *bound};
    last = bound;
  }
  if (last)
    refuse(accuracy, *last);
  refuse(accuracy, why_unbounded(view.lights));
}

// `at_one_range`: the rounding of pixels whose samples are at one range.
ErrorBound error_bound_of(const Accuracy &accuracy, const RoundingBound &rounding, const ReducedLight &light,
                          const std::optional<RoundingBound> &at_one_range = std::nullopt) {
  ErrorBound bound{accuracy.max_error_m,
                   rounding.fixed_m,
                   rounding.per_condition_m + light.error_per_condition_m,
                   accuracy.max_amplitude_error,
                   rounding.amplitude_fixed,
                   rounding.amplitude_per_condition + light.amplitude_error_per_condition,
                   0.0,
                   0.0};
  bound.weight_error = rounding.weight_error;
  bound.per_weight_m = rounding.per_weight_m;
  bound.any_weight_m = rounding.any_weight_m;
  bound.even_part = std::max(rounding.even_part, at_one_range ? at_one_range->even_part : 0.0);
  bound.amplitude_per_weight = rounding.amplitude_per_weight;
  if (at_one_range && std::isfinite(rounding.per_apart))
    bound.at_one_range = {at_one_range->fixed_m, at_one_range->per_condition_m + light.error_per_condition_m,
                          at_one_range->per_weight_m, rounding.per_apart};
  if (rounding.per_weight_m > 0.0 || std::isfinite(bound.amplitude_limit))
    bound.terms_per_weight_error = 1.0 / weight_error_unit;
  bound.terms_of_beam_edges = bound.terms_per_weight_error * rounding.beam_edge_error;
  return bound;
}

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

// As errors_of in shaders/signal/demodulation.glsl.
std::optional<SureBound> sure_bound(const LightFacts &view, const ErrorBound &bound, const FramePlan &plan) {
  const auto condition = largest_condition(view, plan);
  if (!condition || bound.terms_of_beam_edges > 0.0)
    return std::nullopt;
  const double relative = bound.amplitude_per_condition * *condition;
  if (!(relative < 1.0))
    return std::nullopt;
  const double per_condition_m =
      bound.per_condition_m + bound.weight_error * bound.even_part * bound.per_weight_m;
  return SureBound{bound.fixed_m + per_condition_m * *condition / (1.0 - relative),
                   bound.amplitude_fixed + relative};
}

// Where no bound is known before the frame, every pixel makes sure of the limits, so that these are claimed.
void claim_within_limits(const LightFacts &view, const ErrorBound &bound, FramePlan &plan) {
  const auto sure = sure_bound(view, bound, plan);
  plan.surely_kept = sure && sure->distance_m <= bound.limit_m && sure->amplitude <= bound.amplitude_limit;
  plan.claimed_m = plan.surely_kept ? sure->distance_m : bound.limit_m;
  if (sure || std::isfinite(bound.amplitude_limit))
    plan.claimed_amplitude = std::min(sure ? sure->amplitude : bound.amplitude_limit, bound.amplitude_limit);
}

std::optional<ErrorBound> bound_beforehand(const LightFacts &view, const Accuracy &accuracy,
                                           const FramePlan &plan) {
  if (plan.all.polynomials.point_dimensions == 0)
    return std::nullopt;
  const std::uint32_t samples = view.sensor.samples;
  const auto rounding = bound_of(view, plan.all, plan.precision, samples, std::nullopt, true);
  if (!rounding)
    return std::nullopt;
  return error_bound_of(accuracy, *rounding, whole_light(view.lights),
                        at_one_range(view, plan.all, plan.precision, samples, true));
}

ReducedLight light_within(const LightFacts &view, const Accuracy &accuracy, const RoundingBound &rounding,
                          double typical, double share) {
  if (share == 0.0 || view.modulation.waveform != shader::waveform_sine)
    return whole_light(view.lights);
  const double rounding_m = std::min(rounding.distance_m(1.0), rounding.distance_m_at(typical));
  if (rounding_m >= accuracy.max_error_m) // where samples are farther apart than most pixels' are
    return whole_light(view.lights);
  return reduce_diodes(view.lights, view.visible, view.backscatter, wavenumbers_rad_m(view.modulation),
                       std::min(share * (accuracy.max_error_m - rounding_m),
                                std::max(least_share_of_reduction * accuracy.max_error_m, rounding_m)),
                       share * (accuracy.max_amplitude_error - rounding.amplitude(1.0)));
}

bool is_kept_by_some(const ErrorBound &bound) {
  return bound.nearest_m(1.0) <= bound.limit_m &&
         bound.amplitude_fixed + bound.amplitude_per_condition <= bound.amplitude_limit;
}

// One point in float, or four, whatever the precision of the others.
void plan_uniform_pixels(const LightFacts &view, const Accuracy &accuracy, const ReducedLight &light,
                         FramePlan &plan) {
  const bool in_float = accuracy.precision != Precision::fp64;
  if (in_float)
    plan.uniform_groups = groups_of(view, light.illuminators, Precision::fp32);
  // How much light a sample has is counted in these, also where pixels are only listed.
  plan.uniform_groups.diode_count = plan.all.diode_count;
  if (!in_float)
    return;
  const auto bound_at = [&](std::uint32_t side, double spread_m) -> std::optional<ErrorBound> {
    const auto rounding = bound_of(view, plan.uniform_groups, Precision::fp32, side, spread_m);
    if (!rounding)
      return std::nullopt;
    const ErrorBound bound = error_bound_of(accuracy, *rounding, light,
                                            at_one_range(view, plan.uniform_groups, Precision::fp32, side));
    return is_kept_by_some(bound) ? std::optional(bound) : std::nullopt;
  };
  plan.uniform_bound = bound_at(1, 0.0);
  if (plan.uniform_bound && view.sensor.samples > 1)
    plan.refined_bound = bound_at(2, point_spread_m);
}

// The largest of the bounds of what is summed in float, at a condition.
double largest_m(const FramePlan &plan, double condition) {
  double largest = 0.0;
  for (const auto *bound : {&plan.bound, &plan.bound_of_all, &plan.bound_beforehand})
    if (*bound)
      largest = std::max(largest, (*bound)->nearest_m(condition));
  return largest;
}

// For the pixels that float is not exact enough for. Bits that tell which sources reach a sample are in the
// order of the plan's sources.
void plan_precise_pixels(const LightFacts &view, const Accuracy &accuracy, FramePlan &plan) {
  if (plan.surely_kept || plan.precision == Precision::fp64 || accuracy.precision ||
      view.sensor.has_distortion() ||
      (view.modulation.lit && plan_windows(plan.all, view.window_bundles).size() > 1))
    return;
  SourceGroups groups =
      precise_groups(view.lights, view.visible, view.modulation.largest_wavenumber_rad_m(), plan.all);
  const auto rounding = bound_of(view, groups, Precision::fp64, view.sensor.samples);
  if (!rounding)
    return;
  plan.precise = std::move(groups);
  plan.bound_of_precise =
      error_bound_of(accuracy, *rounding, whole_light(view.lights),
                     at_one_range(view, *plan.precise, Precision::fp64, view.sensor.samples));
  // Diagrams take long to be looked up in double: only pixels beyond the budget try it.
  if (std::ranges::any_of(plan.all.positions,
                          [](const SourcePosition &place) { return place.law_error > 0.0; }))
    return;
  if (view.sensor.samples > 1 && view.modulation.lit) // all at once, many of them at edges: it takes too long
    return;
  const double usual_m = largest_m(plan, largest_growth(plan));
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
  if (const auto rounding = bound_of(view, plan.all, plan.precision, view.sensor.samples)) {
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

ErrorBound worse_of(ErrorBound a, const ErrorBound &b) {
  for (const auto part :
       {&ErrorBound::fixed_m, &ErrorBound::per_condition_m, &ErrorBound::amplitude_fixed,
        &ErrorBound::amplitude_per_condition, &ErrorBound::terms_per_weight_error,
        &ErrorBound::terms_of_beam_edges, &ErrorBound::weight_error, &ErrorBound::per_weight_m,
        &ErrorBound::any_weight_m, &ErrorBound::amplitude_per_weight, &ErrorBound::even_part})
    a.*part = std::max(a.*part, b.*part);
  using Near = ErrorBound::AtOneRange;
  if (!b.at_one_range)
    a.at_one_range.reset();
  if (a.at_one_range)
    for (const auto part : {&Near::fixed_m, &Near::per_condition_m, &Near::per_weight_m, &Near::per_apart})
      (*a.at_one_range).*part = std::max((*a.at_one_range).*part, (*b.at_one_range).*part);
  return a;
}

FramePlan plan_frame(const LightFacts &view, const Accuracy &accuracy, std::uint32_t attempt) {
  if (accuracy.mode == Mode::exact)
    return exact_plan(view, accuracy);
  FramePlan plan;
  const double typical =
      typical_condition(view.lights, view.visible, view.modulation.largest_wavenumber_rad_m());
  RoundedSum sum = choose_precision(view, accuracy, typical, attempt);
  const ReducedLight light = light_within(view, accuracy, sum.bound, typical, share_of_reduction[attempt]);
  plan.precision = sum.precision;
  plan.all = std::move(sum.groups);
  plan.reduced = groups_of(view, light.illuminators, plan.precision,
                           tolerance_of(view, plan.precision, accuracy, share_of_series[attempt]),
                           plan.all.near_polynomials ? HighPowers::by_tables : HighPowers::by_roots);
  plan.reduced.diode_count = plan.all.diode_count; // how much light a sample has is counted in these
  plan.extent = {light.lights, pattern_slope(view.lights, view.visible)};
  const std::uint32_t samples = view.sensor.samples;
  const auto of_all = at_one_range(view, plan.all, plan.precision, samples);
  plan.bound_of_all = error_bound_of(accuracy, sum.bound, whole_light(view.lights), of_all);
  if (const auto of_reduced = bound_of(view, plan.reduced, plan.precision, samples))
    plan.bound = error_bound_of(accuracy, *of_reduced, light,
                                at_one_range(view, plan.reduced, plan.precision, samples));
  else
    plan.bound = error_bound_of(accuracy, sum.bound, light, of_all);
  plan.bound_beforehand = bound_beforehand(view, accuracy, plan);
  plan_uniform_pixels(view, accuracy, light, plan);
  ErrorBound worst = worse_of(*plan.bound, plan.uniform_bound.value_or(*plan.bound));
  if (view.modulation.lit || view.model.backscatter != shader::backscatter_flat)
    worst = worse_of(worst, *plan.bound_of_all);
  if (plan.bound_beforehand)
    worst = worse_of(worst, *plan.bound_beforehand);
  claim_within_limits(view, worst, plan);
  plan_precise_pixels(view, accuracy, plan);
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
