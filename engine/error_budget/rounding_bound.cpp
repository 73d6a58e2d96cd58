#include "engine/error_budget/rounding_bound.h"

#include "engine/error_budget/term_rounding.h"
#include "engine/light/path_difference.h"
#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <cmath>
#include <numbers>

// The sum is z = sum_m w_m exp(j phi_m). An error of each weight, w_m (1 + a_m), turns z by sum w_m a_m
// sin(phi_m - arg z) / |z|, at most
//   condition * a * min(kappa * spread, 1)       spread: of the paths, m
// since arg z lies among the phi_m. Errors of all weights by the same part have about half of that effect,
// since w sin(phi - arg z) sums to 0, so that the mean of |sin| is at most half of the sines' range; where a
// run's sum is off as a whole, its reference point counts as its phase. An error of each path by b_m metres
// turns it by condition * kappa * b. Half of the angle over kappa is distance. Both errors are counted
// operation by operation (term_rounding.h), in units of u (engine/light/rounding_units.h).

namespace pmdsim {
namespace {

constexpr double float_rounding = 0x1p-24, precise_rounding = 0x1p-45;
constexpr double pair_rounding = 0x1p-38;     // of ranges: pairs of floats, planes seen at 89 degrees
constexpr double phasor = 10.0;               // u: a phase as a float, its cosine and sine, their product
constexpr double angle = 6.0;                 // u: z as floats, its angle
constexpr double amplitude_of_a_pixel = 24.0; // u: |z|, its scale, the output
constexpr double block = shader::diodes_per_block;
constexpr double unknown = std::numeric_limits<double>::infinity();

// How far apart things are, m.
struct Lengths {
  double range_m = 0.0;  // at most, of what is visible
  double detour_m = 0.0; // at most, |rho - range| over all groups' reference points
  double spread_m = 0.0; // at most, of the paths to all diodes and reference points
  double among_m = 0.0;  // at most, of the paths to all diodes
  double sample_spread_m = 0.0;
};

double farthest_m(const VisibleBox &box) {
  return glm::length(glm::max(glm::abs(box.low_m), glm::abs(box.high_m)));
}

double nearest_m(const VisibleBox &box) {
  return glm::length(glm::clamp(glm::dvec3(0.0), box.low_m, box.high_m));
}

std::vector<glm::dvec3> lit_places(const SourceGroups &groups) {
  std::vector<glm::dvec3> places_m;
  for (const SourcePosition &place : groups.positions)
    if (place.number != no_id)
      places_m.push_back(place.position_m);
  return places_m;
}

Lengths lengths_of(const SourceGroups &groups, const std::vector<VisibleBox> &visible,
                   const RoundingScope &scope) {
  Lengths result;
  double nearest = std::numeric_limits<double>::infinity();
  for (const VisibleBox &box : visible) {
    result.range_m = std::max(result.range_m, farthest_m(box));
    nearest = std::min(nearest, nearest_m(box));
  }
  std::vector<glm::dvec3> references_m;
  for (const SourceRun &run : groups.runs)
    references_m.push_back(run.reference_m);
  result.detour_m = path_difference_of(glm::dvec3(0.0), references_m, visible).path_difference_m;
  const std::vector<glm::dvec3> places_m = lit_places(groups);
  VisibleBox box;
  for (const glm::dvec3 &place_m : places_m)
    box.add(place_m);
  const double about_middle_m =
      path_difference_of(0.5 * (box.low_m + box.high_m), places_m, visible).path_difference_m;
  const double about_lens_m = path_difference_of(glm::dvec3(0.0), places_m, visible).path_difference_m;
  const double across_m = scope.samples > 1 ? scope.pixel_rad * result.range_m : 0.0;
  result.among_m = std::min(2.0 * about_middle_m + across_m, 2.0 * about_lens_m);
  result.spread_m = result.among_m + groups.path_difference_m;
  if (scope.samples > 1)
    result.sample_spread_m = scope.sample_spread_m.value_or(std::max(0.0, result.range_m - nearest));
  return result;
}

// The errors of every term: of its weight, relative, with the part of it that no other tone of the frequency
// has, and of its path.
struct TermError {
  double weight, of_this_tone, path_m;

  // `turning`: at most, |sin| of the angle between a term and the sum.
  double angle_rad(double wavenumber_rad_m, double turning) const {
    return weight * turning + wavenumber_rad_m * path_m;
  }
};

class Bound {
public:
  Bound(const SourceGroups &groups, const std::vector<VisibleBox> &visible, const SumModel &model,
        const Modulation &modulation, const RoundingScope &scope)
      : groups_(groups), model_(model), modulation_(modulation), scope_(scope),
        lengths_(lengths_of(groups, visible, scope)),
        u_(scope.precision == Precision::fp64 ? precise_rounding : float_rounding),
        // One sample's backscatter is common to all its terms.
        weight_(u_ * weight_error(groups, model, scope) +
                (scope.samples > 1 ? scope.backscatter_error : 0.0)) {}

  RoundingBound of(double frequency_hz) const {
    const double wavenumber_rad_m = 2.0 * std::numbers::pi * frequency_hz / speed_of_light_m_s;
    return modulation_.waveform == shader::waveform_square ? of_square(wavenumber_rad_m)
                                                           : of_tones(wavenumber_rad_m);
  }

private:
  // Sums of nonnegative terms: within blocks, then of blocks, then of their stretches (in fp64 one after the
  // other), then of runs and samples, where only a rest is rounded. A term that is added to nothing, or that
  // is dark, is not rounded.
  double summation() const {
    const double samples = scope_.samples;
    const double of_rests = 0x1p-47 * (static_cast<double>(groups_.runs.size()) + samples * samples);
    if (scope_.beforehand)
      return of_rests;
    const double blocks =
        std::min(static_cast<double>(groups_.blocks_per_run), std::ceil(groups_.diode_count / block));
    const double stretch = std::min(blocks, static_cast<double>(shader::blocks_per_stretch));
    const double in_block = std::min(block, static_cast<double>(groups_.diode_count));
    const double of_run = scope_.precision == Precision::fp64
                              ? std::min(block * blocks, static_cast<double>(groups_.diode_count)) - 1.0
                              : in_block + stretch + std::ceil(blocks / stretch) - 3.0;
    return u_ * of_run + of_rests;
  }

  double path_terms_m() const {
    return groups_.polynomials.powers > 0 ? groups_.polynomials.path_terms_m : groups_.path_difference_m;
  }

  // Where the groups' own phases differ, the spread is as bad as any.
  double spread_m() const {
    const auto other = [&](const SourceRun &run) { return run.phase_turns != groups_.runs[0].phase_turns; };
    return std::ranges::any_of(groups_.runs, other) ? std::numeric_limits<double>::infinity()
                                                    : lengths_.spread_m + 2.0 * lengths_.sample_spread_m;
  }

  // How much of an error's effect one has that is the same for all weights. Runs may be off as a whole, too:
  // the only one by no more than its own paths differ, several by that and as their terms are.
  double even_part(double wavenumber_rad_m) const {
    const bool is_one = groups_.runs.size() == 1 && scope_.samples == 1;
    const double half_m = 0.5 * lengths_.among_m + lengths_.sample_spread_m;
    const double even_m =
        is_one ? std::max(half_m, groups_.path_difference_m) : half_m + groups_.path_difference_m;
    return wavenumber_rad_m * spread_m() < 1.0 && spread_m() > 0.0 ? std::min(even_m / spread_m(), 1.0) : 1.0;
  }

  // z's own angle, over kappa: relative to twice a range for a sine without a phase.
  double relative_m() const {
    return modulation_.waveform != shader::waveform_sine || groups_.phased
               ? std::numeric_limits<double>::infinity()
               : lengths_.detour_m + groups_.path_difference_m + 2.0 * lengths_.sample_spread_m;
  }

  // By moments: e^k adds k - 1 products, so that errors of e, and with Horner's rule of each power (11 u),
  // grow as the exponential's derivative does.
  TermError of_tone(double wavenumber_rad_m) const {
    const double phase_rad = wavenumber_rad_m * groups_.path_difference_m, growth = std::exp(phase_rad);
    double left_out = 1.0;
    for (std::uint32_t k = 1; k <= groups_.moments; ++k)
      left_out *= phase_rad / k;
    const MomentPolynomials &powers = groups_.polynomials;
    const bool by_powers = powers.powers > 0; // or, on the host, by others
    const double of_powers =
        by_powers ? std::max(powers.weight_error, near_weight_error(groups_.tolerance)) : 0.0;
    TermError error{weight_ + summation() * growth + 3.0 * u_ + of_powers, 0.0, 0.0};
    // All tones take the same moments; the first is as it is for all of them.
    error.of_this_tone = (growth - 1.0) * (weight_ + summation()) + 3.0 * u_ + of_powers;
    error.path_m =
        growth * u_ * (excess_error_m(groups_, scope_) + 11.0 * groups_.path_difference_m) +
        growth * (summation() * path_terms_m() + left_out / wavenumber_rad_m) +
        (by_powers ? std::max(powers.angle_error_rad, near_angle_error_rad(groups_.tolerance)) : 0.0) /
            modulation_.largest_wavenumber_rad_m();
    const double turned_m = lengths_.detour_m + groups_.path_difference_m;
    error.path_m += phasor * u_ * std::min(turned_m, 1.0 / wavenumber_rad_m);
    if (scope_.samples > 1) // turned again, to the pixel's first
      error.path_m +=
          phasor * u_ * std::min(turned_m + 2.0 * lengths_.sample_spread_m, 1.0 / wavenumber_rad_m);
    return error;
  }

  // The bounds of what the camera takes from the sum.
  RoundingBound fixed(double wavenumber_rad_m) const {
    double ambiguity_m = std::numbers::pi / wavenumber_rad_m;
    if (scope_.precision == Precision::fp64) // half a unit in the last place of the largest float below
      ambiguity_m = std::exp2(std::floor(std::log2(ambiguity_m)));
    const double distance_m =
        groups_.phased
            ? ambiguity_m
            : std::min(ambiguity_m, lengths_.range_m + lengths_.detour_m + groups_.path_difference_m);
    RoundingBound bound{};
    bound.output_m = float_rounding * distance_m;
    bound.fixed_m =
        pair_rounding * lengths_.range_m + 0.5 * angle * u_ * std::min(relative_m(), 1.0 / wavenumber_rad_m);
    bound.amplitude_fixed = amplitude_of_a_pixel * float_rounding + scope_.backscatter_error;
    const BeamError beams = beam_rounding(groups_.diodes, law_rounding(groups_, model_, scope_));
    bound.beams = {u_ * u_ * beams.square, u_ * u_ * beams.square_per_log, beams.darkest};
    if (scope_.beam_edges_are_terms)
      bound.beam_edge_error =
          u_ * beam_edge_rounding_u(groups_.diodes, law_rounding(groups_, model_, scope_));
    return bound;
  }

  RoundingBound of_tones(double wavenumber_rad_m) const {
    return modulation_.waveform == shader::waveform_sine ? of_sine(wavenumber_rad_m)
                                                         : of_harmonics(wavenumber_rad_m);
  }

  RoundingBound of_sine(double wavenumber_rad_m) const {
    const TermError tone = of_tone(wavenumber_rad_m);
    const double turning = std::min(wavenumber_rad_m * spread_m(), 1.0);
    RoundingBound bound = fixed(wavenumber_rad_m);
    // Ranges count there and back, where a term is turned and where the sum's angle is taken.
    bound.per_apart = (phasor + angle) * u_;
    bound.weight_error = tone.weight;
    bound.even_part = even_part(wavenumber_rad_m);
    bound.per_condition_m = 0.5 * tone.path_m;
    bound.amplitude_per_condition = tone.angle_rad(wavenumber_rad_m, 1.0);
    bound.per_weight_m = 0.5 * turning / wavenumber_rad_m;
    bound.any_weight_m = 0.5 / wavenumber_rad_m;
    bound.amplitude_per_weight = 1.0;
    return bound;
  }

  // The taps mistake some harmonics' returns for the fundamental's: a path of phase x returns g(x), the sum
  // of a_h exp(+-j h x) over those. z over the sum of the weights lies in the hull of the g(x), so that |Im(g
  // exp(-j arg z))| is at most what the g differ by: the phases' range times the sum of h |a_h|. Errors that
  // a weight has for one harmonic alone turn z as they may. Every harmonic is turned by its whole phase, in
  // float.
  RoundingBound of_harmonics(double wavenumber_rad_m) const {
    const std::vector<std::uint32_t> shown = shown_harmonics();
    // With its amplitude, which is a float, and in the sums of all samples and of all harmonics.
    const double of_samples = scope_.samples > 1 ? 3.0 : 0.0;
    const double rotation =
        (phasor + of_samples + static_cast<double>(shown.size())) * u_ + std::max(u_, float_rounding);
    double amplitudes = 0.0, slopes = 0.0, weight = 0.0, angle_rad = 0.0, amplitude = 0.0;
    for (const std::uint32_t h : shown) {
      const double of_harmonic = amplitude_of(h);
      const TermError tone = of_tone(h * wavenumber_rad_m);
      amplitudes += of_harmonic;
      slopes += h * of_harmonic;
      weight = std::max(weight, tone.weight);
      angle_rad += of_harmonic * (tone.of_this_tone + h * wavenumber_rad_m * tone.path_m + rotation);
      amplitude += of_harmonic * (tone.angle_rad(h * wavenumber_rad_m, 1.0) + rotation);
    }
    RoundingBound bound = fixed(wavenumber_rad_m);
    if (shown.empty()) // nothing returns
      return bound;
    const double slope = slopes / amplitudes;
    bound.per_apart = shown.back() * phasor * u_; // ranges count there and back
    bound.weight_error = weight;
    bound.even_part = 1.0;
    bound.per_condition_m = 0.5 * angle_rad / amplitudes / wavenumber_rad_m;
    bound.amplitude_per_condition = amplitude / amplitudes;
    bound.per_weight_m = 0.5 * std::min(slope * wavenumber_rad_m * spread_m(), 1.0) / wavenumber_rad_m;
    bound.any_weight_m = unknown;
    bound.amplitude_per_weight = slope;
    return bound;
  }

  double amplitude_of(std::uint32_t harmonic) const {
    return std::abs(static_cast<double>(modulation_.harmonics[harmonic - 1]));
  }

  // Those that the taps take for the fundamental.
  std::vector<std::uint32_t> shown_harmonics() const {
    std::vector<std::uint32_t> shown;
    for (std::uint32_t h = 1; h <= modulation_.tones; ++h)
      if (taps_show(h, modulation_.taps) && amplitude_of(h) > 0.0)
        shown.push_back(h);
    return shown;
  }

  // With C = 4 ||x| - 1/2| - 1, x in turns, a tap is C of the reference path times the sum of the weights,
  // and the sum of 4 w times what ||x| - 1/2| differs by there, which is what x differs by at most. The first
  // sum is common to all taps. z is 2 / N times the sum of N taps. The reference path's turns, at most a
  // half, and x, at most 1, are rounded.
  RoundingBound of_square(double wavenumber_rad_m) const {
    RoundingBound bound = fixed(wavenumber_rad_m);
    const double turns_per_m = wavenumber_rad_m / (2.0 * std::numbers::pi);
    const double apart_turns = turns_per_m * groups_.path_difference_m;
    const double place_turns =
        2.0 * u_ + turns_per_m * u_ * (excess_error_m(groups_, scope_) + 2.0 * groups_.path_difference_m);
    const double tap = 4.0 * place_turns + 4.0 * apart_turns * summation() + 6.0 * u_;
    const double z = 2.0 * (tap + (6.0 + modulation_.taps) * u_);
    // The wave's corners turn z at most twice as fast as the path's phase.
    const double turning = std::min(2.0 * wavenumber_rad_m * spread_m(), 2.0);
    bound.per_apart = angle * u_;
    bound.weight_error = weight_;
    bound.per_condition_m = 0.5 * z / wavenumber_rad_m;
    bound.amplitude_per_condition = z + summation() + 2.0 * weight_;
    bound.per_weight_m = 0.5 * turning / wavenumber_rad_m;
    bound.even_part = 1.0;
    bound.any_weight_m = unknown;
    bound.amplitude_per_weight = 2.0;
    return bound;
  }

  const SourceGroups &groups_;
  const SumModel &model_;
  const Modulation &modulation_;
  const RoundingScope &scope_;
  Lengths lengths_;
  double u_;
  double weight_; // relative error of each
};

// To the bounds of all frequencies.
void raise_to(RoundingBound &largest, const Bound &bound, const Modulation &modulation) {
  for (const double frequency_hz : modulation.modulation_hz) {
    const RoundingBound of_frequency = bound.of(frequency_hz);
    using Part = RoundingBound;
    for (const auto part :
         {&Part::fixed_m, &Part::per_condition_m, &Part::amplitude_fixed, &Part::amplitude_per_condition,
          &Part::weight_error, &Part::per_weight_m, &Part::amplitude_per_weight, &Part::any_weight_m,
          &Part::beam_edge_error, &Part::per_apart, &Part::even_part, &Part::output_m})
      largest.*part = std::max(largest.*part, of_frequency.*part);
    for (const auto part : {&BeamError::square, &BeamError::square_per_log, &BeamError::darkest})
      largest.beams.*part = std::max(largest.beams.*part, of_frequency.beams.*part);
  }
}

} // namespace

std::optional<RoundingBound> rounding_bound(const SourceGroups &groups,
                                            const std::vector<VisibleBox> &visible, const SumModel &model,
                                            const Modulation &modulation, const RoundingScope &scope) {
  if (!std::ranges::all_of(groups.positions,
                           [](const SourcePosition &place) { return std::isfinite(place.law_error); }))
    return std::nullopt;
  RoundingBound largest{};
  raise_to(largest, Bound(groups, visible, model, modulation, scope), modulation);
  const auto raise_to_sums_by = [&](const MomentPolynomials &polynomials) {
    SourceGroups otherwise = groups;
    otherwise.polynomials = polynomials;
    raise_to(largest, Bound(otherwise, visible, model, modulation, scope), modulation);
  };
  if (groups.near_polynomials) // in place of roots
    raise_to_sums_by(*groups.near_polynomials);
  if (groups.polynomials.powers > 0 && !scope.beforehand) // the host draws roots where no table does
    raise_to_sums_by({});
  return largest;
}

} // namespace pmdsim
