#pragma once
// A bound of the rounding of a frame, from theory: known before the frame, from the light and from boxes
// around what is visible.

#include "engine/error_budget/emission_cosine.h"
#include "engine/light/sum_model.h"
#include "engine/model/accuracy.h"
#include "engine/view/camera_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace pmdsim {

// The error of any pixel against the same sum in exact arithmetic. `condition` is the pixel's, sum of |terms|
// over |sum|, >= 1, the terms times the factor by which rounding grows there (MomentPolynomials::growth at
// most); for harmonics the terms are those of all that the taps take for the fundamental, each times its
// amplitude.
struct RoundingBound {
  double output_m; // of the distance as a float, at most
  double fixed_m, per_condition_m;
  double amplitude_fixed, amplitude_per_condition;
  // The relative error of every weight, which per_condition_m leaves out, and the effect of errors of single
  // weights, over them and the condition. An error turns the sum only as far as the terms' angles differ. One
  // that all weights have has this part of the effect, and no more than `any_weight_m` times sqrt(condition^2
  // - 1); infinite where that does not hold.
  double weight_error, per_weight_m, even_part, any_weight_m, amplitude_per_weight;
  // Not included where RoundingScope::beams_are_terms: errors of weights in narrow beams.
  BeamError beams;
  // Not included where RoundingScope::beam_edges_are_terms: the relative error of J, times the cosine to the
  // diode's axis and over the order.
  double beam_edge_error;
  // The most that fixed_m and per_condition_m together grow by for each metre between the ranges of a pixel's
  // samples, at any condition, while per_weight_m grows by amplitude_per_weight at most; infinite where that
  // is not known.
  double per_apart;

  // `dimming`: -ln of the beams' mean J there.
  double distance_m(double condition, double dimming = 0.0) const {
    const double of_weights = weight_error * even_part + beams.at(dimming);
    return output_m + fixed_m + (per_condition_m + of_weights * per_weight_m) * condition;
  }
  // The same where the condition is a pixel's own, which says more of the error that all weights have; it is
  // off as the amplitude is.
  double distance_m_at(double condition, double dimming = 0.0) const {
    const double largest = condition * (1.0 + 2.0 * amplitude(condition, dimming));
    const double any_m = any_weight_m * std::sqrt(std::max(largest * largest - 1.0, 0.0));
    const double most_m = per_weight_m * condition;
    return output_m + fixed_m + per_condition_m * condition +
           weight_error * std::min(even_part * most_m, any_m) + beams.at(dimming) * std::min(most_m, any_m);
  }
  double amplitude(double condition, double dimming = 0.0) const {
    return amplitude_fixed + (amplitude_per_condition + amplitude_per_weight * beams.at(dimming)) * condition;
  }
};

inline constexpr double beam_cosine = std::numbers::sqrt2 / 2.0; // beside it a beam's rim begins

// The pixels that the bound is for, and how they are summed.
struct RoundingScope {
  Precision precision = Precision::fp32; // the groups', too
  std::uint32_t samples = 1;             // S
  // How much the ranges of a pixel's samples may differ; nothing: as much as the boxes allow. Not asked for
  // with one sample.
  std::optional<double> sample_spread_m = std::nullopt;
  // How far apart a pixel's samples are across the view, over their range; likewise.
  double pixel_rad = std::numeric_limits<double>::infinity();
  // Every diode that lights the pixel does so at these cosines at least: to the surface's normal, which
  // matters to Lambert's law, and to its own axis.
  double incidence_cosine = grazing_cosine, emission_cosine = grazing_cosine;
  // Light more than 45 degrees off its diode's axis is in the pixel's terms instead (shaders/light/sum.glsl).
  bool beam_edges_are_terms = false;
  bool beams_are_terms = false; // narrow beams' errors are in the pixel's terms
  bool beforehand = false;      // the groups are summed beforehand (point_polynomials.h)
  // The relative error of a surface's backscatter: one rounding. Paint and vignetting add a few.
  double backscatter_error = 0x1p-24;
};

// Nothing where a diode's law has no bound (law_error). The errors of diagrams are in the pixel's terms
// (shaders/light/sum.glsl), as grazing light is where the scope's incidence_cosine is 1.
std::optional<RoundingBound> rounding_bound(const SourceGroups &groups,
                                            const std::vector<VisibleBox> &visible, const SumModel &model,
                                            const Modulation &modulation, const RoundingScope &scope);

} // namespace pmdsim
