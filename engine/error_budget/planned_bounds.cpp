#include "engine/error_budget/planned_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// Relative errors: one rounding; those of paint, texture and vignetting.
constexpr double plain_backscatter_error = 0x1p-24, painted_backscatter_error = 0x1p-21;

// An upper bound of a pixel's angle, seen from the lens.
double pixel_rad(const Sensor &sensor) {
  if (sensor.has_distortion() || !sensor.chip.is_nominal())
    return std::numeric_limits<double>::infinity();
  return glm::length(sensor.pixel_pitch_m * sensor.fill_factor) / sensor.image_distance_m();
}

} // namespace

std::optional<RoundingBound> bound_of(const LightFacts &view, const SourceGroups &groups,
                                      const PlannedSum &sum) {
  RoundingScope scope;
  scope.beforehand = sum.beforehand;
  scope.sample_spread_m = sum.sample_spread_m;
  scope.precision = sum.precision;
  scope.samples = sum.samples;
  scope.pixel_rad = pixel_rad(view.sensor);
  scope.incidence_cosine = 1.0; // where light grazes a surface, the pixel's terms have it
  scope.emission_cosine = least_emission_cosine(groups, view.visible);
  scope.beam_edges_are_terms = scope.emission_cosine < beam_cosine;
  scope.beams_are_terms = sum.knows_pixels;
  scope.backscatter_error = view.painted || view.sensor.vignetting != Vignetting::none
                                ? painted_backscatter_error
                                : plain_backscatter_error;
  return rounding_bound(groups, view.visible, view.model, view.modulation, scope);
}

std::optional<RoundingBound> at_one_range(const LightFacts &view, const SourceGroups &groups,
                                          PlannedSum sum) {
  if (sum.samples == 1)
    return std::nullopt;
  sum.sample_spread_m = 0.0;
  return bound_of(view, groups, sum);
}

ErrorBound error_bound_of(const Accuracy &accuracy, const RoundingBound &rounding, const ReducedLight &light,
                          const std::optional<RoundingBound> &at_one_range) {
  ErrorBound bound{accuracy.max_error_m,
                   rounding.fixed_m,
                   rounding.per_condition_m + light.error_per_condition_m,
                   accuracy.max_amplitude_error,
                   rounding.amplitude_fixed,
                   rounding.amplitude_per_condition + light.amplitude_error_per_condition,
                   0.0,
                   0.0};
  bound.beams = rounding.beams;
  bound.output_m = rounding.output_m;
  bound.weight_error = rounding.weight_error;
  bound.per_weight_m = rounding.per_weight_m;
  bound.any_weight_m = rounding.any_weight_m;
  bound.even_part = rounding.even_part;
  bound.amplitude_per_weight = rounding.amplitude_per_weight;
  if (at_one_range && std::isfinite(rounding.per_apart))
    bound.at_one_range = {at_one_range->fixed_m, at_one_range->per_condition_m + light.error_per_condition_m,
                          at_one_range->per_weight_m, rounding.per_apart, at_one_range->even_part};
  if (rounding.per_weight_m > 0.0 || std::isfinite(bound.amplitude_limit) || rounding.beams.square > 0.0)
    bound.terms_per_weight_error = 1.0 / weight_error_unit;
  bound.terms_of_beam_edges = bound.terms_per_weight_error * rounding.beam_edge_error;
  return bound;
}

ErrorBound worse_of(ErrorBound a, const ErrorBound &b) {
  for (const auto part : {&ErrorBound::fixed_m, &ErrorBound::per_condition_m, &ErrorBound::amplitude_fixed,
                          &ErrorBound::amplitude_per_condition, &ErrorBound::terms_per_weight_error,
                          &ErrorBound::terms_of_beam_edges, &ErrorBound::weight_error,
                          &ErrorBound::per_weight_m, &ErrorBound::any_weight_m,
                          &ErrorBound::amplitude_per_weight, &ErrorBound::even_part, &ErrorBound::output_m})
    a.*part = std::max(a.*part, b.*part);
  for (const auto part : {&BeamError::square, &BeamError::square_per_log, &BeamError::darkest})
    a.beams.*part = std::max(a.beams.*part, b.beams.*part);
  using Near = ErrorBound::AtOneRange;
  if (!b.at_one_range)
    a.at_one_range.reset();
  if (a.at_one_range)
    for (const auto part :
         {&Near::fixed_m, &Near::per_condition_m, &Near::per_weight_m, &Near::per_apart, &Near::even_part})
      (*a.at_one_range).*part = std::max((*a.at_one_range).*part, (*b.at_one_range).*part);
  return a;
}

} // namespace pmdsim
