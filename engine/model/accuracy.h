#pragma once
// How exact a frame shall be, and how exact it was found to be. The truth is eq. 5 to 7's sum over
// the sensor's S x S samples and all diodes in exact arithmetic (docs/theory.md, "The measurement").

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace pmdsim {

// exact: every sample times every diode. reduced: fewer, weighted diodes stand in for all, within the error
// asked for. automatic: the cheapest diodes, samples and precision that stay within it.
enum class Mode { exact, reduced, automatic };

// The arithmetic of the sum over the diodes.
enum class Precision { fp32, fp64 };

inline constexpr double default_max_error_m = 10e-6;

// The accuracy asked for.
struct Accuracy {
  Mode mode = Mode::exact;
  std::optional<Precision> precision; // nothing: fp32, or what the error takes
  double max_error_m =
      default_max_error_m; // of distance in every pixel, wrapped; in mode exact of adaptive samples only
  double max_amplitude_error = std::numeric_limits<double>::infinity(); // relative, likewise
  bool strict = false; // a frame some of whose pixels may be off by more is refused, not returned

  bool operator==(const Accuracy &) const = default;
};

// The accuracy of a frame. Errors are of distance, wrapped, and of amplitude, relative, each the largest of
// all pixels that keep what was asked for.
struct AccuracyReport {
  Precision precision = Precision::fp32; // of pixels for which few points in float were not enough
  std::uint32_t diodes = 0;              // summed where all reach a point: those that stand in for all
  // A bound from theory, known before the frame or kept by every pixel; nothing where theory has none.
  std::optional<double> claimed_m, claimed_amplitude;
  // The errors of pixels chosen at random (fixed seed) and evaluated exactly; nothing where that was not
  // asked for.
  std::optional<double> found_m, found_amplitude;
  std::size_t checked_pixels = 0;
  double check_ms = 0.0; // not part of Measurement::frame_ms
  // The number of returns, one for each pixel and frequency, that may be off by more than was asked for
  // (Return::error_bound_m).
  std::size_t unpromised = 0;
};

// The unit of weights' relative errors: small, so that little light keeps its digits.
inline constexpr double weight_error_unit = 0x1p-24;

// The relative error of a weight within a diode's beam, J below 1: its square is at most -ln J times (square
// + square_per_log times -ln J), where square is twice square_per_log at least, so that J times that is
// concave in J.
struct BeamError {
  double square = 0.0, square_per_log = 0.0;
  double darkest = 0.0; // the largest -ln J within beams, beside their rims

  // Of weights whose mean J is at least exp(-dimming): the root of their mean square.
  double at(double dimming) const { return std::sqrt(dimming * (square + square_per_log * dimming)); }
};

// Every pixel's error, and the limit that was asked for. A pixel is off by fixed + per_condition * condition
// at most, the condition being sum of |terms| / |sum| over its samples and diodes, and by the effect of
// errors of weights.
struct ErrorBound {
  double limit_m, fixed_m, per_condition_m;                         // of distance, wrapped; see output_m
  double amplitude_limit, amplitude_fixed, amplitude_per_condition; // relative
  // Further errors of single diodes' weights, relative, are summed apart, times this factor; 0: they are not.
  double terms_per_weight_error = 0.0;
  // Where beams may end in view: that factor times the rounding of a cosine to a diode's axis, for order 1.
  double terms_of_beam_edges = 0.0;
  BeamError beams = {}; // of weights; not included elsewhere
  // The rounding of the distance to a float, at most; what it comes to in a pixel is not in fixed_m.
  double output_m = 0.0;
  // The relative error of every weight, which amplitude_per_condition includes and per_condition_m does not.
  double weight_error = 0.0;
  // The effects of weights' errors, for each unit of those over |sum|: on distance, on distance for the
  // common error over sqrt(condition^2 - 1), and on amplitude (RoundingBound).
  double per_weight_m = 0.0, any_weight_m = 0.0, amplitude_per_weight = 0.0;
  double even_part = 1.0; // of the first, which the common error has
  // The same for distance where a pixel's samples are at one range. For each metre between the ranges fixed_m
  // and per_condition_m together grow by per_apart at most, and per_weight_m by amplitude_per_weight; nothing
  // where that is not known.
  struct AtOneRange {
    double fixed_m, per_condition_m, per_weight_m, per_apart;
    double even_part = 1.0; // at one range
  };
  std::optional<AtOneRange> at_one_range = std::nullopt;

  AtOneRange nearest() const {
    return at_one_range.value_or(AtOneRange{fixed_m, per_condition_m, per_weight_m, 0.0, even_part});
  }
  // Of samples at one range, where no weight is off by itself but for beams' (BeamError::at).
  double nearest_m(double condition, double dimming) const {
    const AtOneRange near = nearest();
    const double of_weights_m = (weight_error * near.even_part + beams.at(dimming)) * near.per_weight_m;
    return output_m + near.fixed_m + (near.per_condition_m + of_weights_m) * condition;
  }
};

} // namespace pmdsim
