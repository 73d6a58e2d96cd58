#include "engine/light/moment_polynomials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::uint32_t most_powers = shader::largest_powers;
constexpr std::uint32_t probes =
    97; // where errors are looked for; between the zeros of any of the polynomials

// The least cosine that matters among a weight's factors (shaders/light/sum.glsl: where beams end).
constexpr double least_cosine = 1e-4;
constexpr double smallest_float = 1e-30,
                 largest_float = 1e36; // terms much smaller than others do not count

// A range of u.
struct Interval {
  double low, high;

  double at(double t) const { return 0.5 * (low + high) + 0.5 * (high - low) * t; } // t from -1 to 1
};

// A hair wider, as the shader's q is rounded; a single point where all diodes stand in the reference's place.
Interval interval_of(const PathDifference &reach) {
  const double rounding = 1e-6 * std::max(reach.most_stretch, -reach.least_stretch);
  return {reach.least_stretch - rounding, reach.most_stretch + rounding};
}

// The largest |u|.
double largest_stretch(const PathDifference &reach) {
  const Interval interval = interval_of(reach);
  return std::max(interval.high, -interval.low);
}

double moment_factor(double u, double inverse_powers, std::uint32_t k) {
  return std::pow(1.0 + u, -0.5 * inverse_powers) * std::pow(std::sqrt(1.0 + u) - 1.0, k);
}

using Coefficients = std::array<double, most_powers>; // of 1, u, u^2, ...

double value(const Coefficients &a, double u) {
  double sum = 0.0;
  for (std::size_t i = a.size(); i-- > 0;)
    sum = sum * u + a[i];
  return sum;
}

// Newton's divided differences, multiplied out; the coefficients as the shader has them, rounded to float.
Coefficients interpolate(const Interval &interval, double inverse_powers, std::uint32_t k,
                         std::uint32_t powers) {
  std::array<double, most_powers> nodes{}, differences{};
  for (std::uint32_t j = 0; j < powers; ++j) {
    nodes[j] = interval.at(std::cos(std::numbers::pi * (j + 0.5) / powers));
    differences[j] = moment_factor(nodes[j], inverse_powers, k);
  }
  for (std::uint32_t order = 1; order < powers; ++order)
    for (std::uint32_t j = powers - 1; j >= order; --j)
      differences[j] = (differences[j] - differences[j - 1]) / (nodes[j] - nodes[j - order]);
  Coefficients a{};
  for (std::uint32_t j = powers; j-- > 0;) { // a = a (u - node) + difference
    for (std::uint32_t i = powers - 1; i > 0; --i)
      a[i] = a[i - 1] - nodes[j] * a[i];
    a[0] = differences[j] - nodes[j] * a[0];
  }
  for (double &coefficient : a)
    coefficient = static_cast<double>(static_cast<float>(coefficient));
  return a;
}

// Raises `so_far` to `value`; a NaN is as bad as can be.
void raise(double &so_far, double value) {
  if (!(value <= so_far))
    so_far = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

// The polynomial's largest error over the interval, relative to the weight.
double error_of(const Coefficients &a, const Interval &interval, double inverse_powers, std::uint32_t k) {
  double error = 0.0;
  for (std::uint32_t i = 0; i < probes; ++i) {
    const double u = interval.at(std::cos(std::numbers::pi * i / (probes - 1)));
    raise(error,
          std::abs(value(a, u) - moment_factor(u, inverse_powers, k)) / moment_factor(u, inverse_powers, 0));
  }
  return error;
}

Coefficients sizes_of(const Coefficients &a) {
  Coefficients sizes{};
  std::ranges::transform(a, sizes.begin(), [](double coefficient) { return std::abs(coefficient); });
  return sizes;
}

// As the shader bounds |u|.
double largest_u(double radius_m, double rho_m) {
  const double t = radius_m / rho_m;
  return 1.000001 * t * (t + 2.0);
}

// At one place and any smaller u; `of_moments`: sizes of the coefficients of each.
double path_terms_at_m(std::span<const Coefficients> of_moments, double most_u, double rho_m,
                       double wavenumber_rad_m) {
  constexpr int steps = 3;
  double most_m = 0.0;
  for (int step = 1; step <= steps; ++step) {
    const double u = most_u * step / steps;
    double sum_m = 0.0, phase_power = rho_m; // (kappa rho)^k / k! over kappa
    for (std::size_t k = 1; k < of_moments.size(); ++k) {
      sum_m += phase_power * value(of_moments[k], u);
      phase_power *= wavenumber_rad_m * rho_m / static_cast<double>(k + 1);
    }
    raise(most_m, sum_m / value(of_moments[0], u));
  }
  return most_m;
}

// Where |u| is at most `most_u`.
double path_terms_m(std::span<const Coefficients> of_moments, const PathDifference &reach,
                    double wavenumber_rad_m, double most_u = std::numeric_limits<double>::infinity()) {
  constexpr int places = 32;
  double most_m = 0.0;
  for (int i = 0; i <= places && std::isfinite(reach.range_m); ++i) { // nothing is seen at infinity
    const double rho_m =
        reach.range_m * std::pow(reach.farthest_m / reach.range_m, static_cast<double>(i) / places);
    const double u = std::min(most_u, largest_u(reach.radius_m, rho_m));
    raise(most_m, path_terms_at_m(of_moments, u, rho_m, wavenumber_rad_m));
  }
  return most_m;
}

// A run's polynomials, judged.
struct Run {
  MomentPolynomials::Table table{};
  double weight_error = 0.0, angle_error_rad = 0.0, growth = 1.0, path_terms_m = 0.0;
};

// Over an interval, at places up to farthest_m; `sizes`: where given, of the coefficients of each moment.
Run fit_run(const Interval &interval, double farthest_m, double inverse_powers, std::uint32_t moments,
            std::uint32_t powers, double wavenumber_rad_m, std::vector<Coefficients> *sizes = nullptr) {
  Run run;
  double phase_power = 1.0; // (kappa rho)^k / k!
  for (std::uint32_t k = 0; k < moments; ++k) {
    const Coefficients a = interpolate(interval, inverse_powers, k, powers);
    for (std::uint32_t i = 0; i < powers; ++i)
      run.table[shader::largest_powers / 4 * k + i / 4][static_cast<int>(i % 4)] = static_cast<float>(a[i]);
    if (sizes)
      sizes->push_back(sizes_of(a));
    (k == 0 ? run.weight_error : run.angle_error_rad) +=
        phase_power * error_of(a, interval, inverse_powers, k);
    phase_power *= wavenumber_rad_m * farthest_m / (k + 1);
  }
  return run;
}

Run make_run(const PathDifference &reach, double inverse_powers, std::uint32_t moments, std::uint32_t powers,
             double wavenumber_rad_m) {
  const Interval interval = interval_of(reach);
  std::vector<Coefficients> sizes;
  Run run = fit_run(interval, reach.farthest_m, inverse_powers, moments, powers, wavenumber_rad_m, &sizes);
  raise(run.growth, value(sizes[0], largest_u(reach.radius_m, reach.range_m)) /
                        moment_factor(interval.high, inverse_powers, 0));
  raise(run.path_terms_m, path_terms_m(sizes, reach, wavenumber_rad_m));
  return run;
}

// As good as float32's own rounding, and where a wavelength is long no more than 2^-18 of e; or within a
// tolerance.
constexpr double largest_weight_error = 0x1p-23, largest_angle_error_rad = 0x1p-24;
bool is_exact_enough(const Run &run, double phase_rad, double tolerance, double part = 1.0) {
  const double angle_rad = std::min(largest_angle_error_rad, 0x1p-18 * phase_rad);
  return run.weight_error <= part * std::max(largest_weight_error, tolerance) &&
         run.angle_error_rad <= part * std::max(angle_rad, tolerance);
}
constexpr double near_part = 0.25;

// With the fewest powers that are exact enough.
std::optional<std::pair<std::uint32_t, Run>> shortest_run(const PathDifference &reach, double inverse_powers,
                                                          std::uint32_t moments, double wavenumber_rad_m,
                                                          double tolerance) {
  if (!std::isfinite(reach.most_stretch))
    return std::nullopt;
  for (std::uint32_t powers = 1; powers <= most_powers; ++powers) {
    const Run run = make_run(reach, inverse_powers, moments, powers, wavenumber_rad_m);
    if (is_exact_enough(run, wavenumber_rad_m * reach.path_difference_m, tolerance))
      return std::pair(powers, run);
  }
  return std::nullopt;
}

// W is a product of an intensity and lengths, each a range times a cosine; q = u rho^2.
bool fits_floats(const PathDifference &reach, double lengths, std::uint32_t powers, double least_intensity) {
  const double near_m = std::min(1.0, reach.range_m - reach.radius_m);
  const double far_m = std::max(1.0, reach.farthest_m + reach.radius_m);
  const double of_q = std::max(2.0 * (powers - 1.0), 2.0);
  return least_intensity * std::pow(near_m * least_cosine, lengths) * std::pow(near_m, of_q) >
             smallest_float &&
         std::pow(far_m, lengths + of_q) < largest_float;
}

} // namespace

double near_weight_error(double tolerance) { return near_part * std::max(largest_weight_error, tolerance); }
double near_angle_error_rad(double tolerance) {
  return near_part * std::max(largest_angle_error_rad, tolerance);
}

std::vector<std::uint32_t> near_powers(std::uint32_t of_frame) {
  std::vector<std::uint32_t> powers{4, 6, 8};
  if (of_frame == 0 || of_frame > powers.back())
    powers.push_back(of_frame == 0 ? shader::largest_powers : of_frame);
  return powers;
}

std::optional<NearPolynomials> fit_near_polynomials(const PathDifference &reach, double inverse_powers,
                                                    std::uint32_t moments, double wavenumber_rad_m,
                                                    std::uint32_t powers, double tolerance,
                                                    double largest_growth) {
  const double phase_rad = wavenumber_rad_m * reach.path_difference_m;
  std::optional<NearPolynomials> widest;
  constexpr int steps = 10;
  double within = 0.0, beyond = 1.0; // they are exact enough for the one, and not for the other
  for (int step = 0; step < steps; ++step) {
    const double u = 0.5 * (within + beyond);
    std::vector<Coefficients> sizes;
    const Run run =
        fit_run({-u, u}, reach.farthest_m, inverse_powers, moments, powers, wavenumber_rad_m, &sizes);
    const bool is_enough =
        is_exact_enough(run, phase_rad, tolerance, near_part) && value(sizes[0], u) <= largest_growth;
    (is_enough ? within : beyond) = u;
    if (is_enough)
      widest = NearPolynomials{u, run.table};
  }
  return widest;
}

std::optional<MomentPolynomials> bound_near_polynomials(std::span<const PathDifference> reaches,
                                                        double inverse_powers, std::uint32_t moments,
                                                        double wavenumber_rad_m, double tolerance,
                                                        double largest_growth) {
  MomentPolynomials bound;
  for (const std::uint32_t powers : near_powers(0))
    for (std::size_t i = 0; i < reaches.size(); ++i) {
      const PathDifference &reach = reaches[i];
      if (i > 0 && reach == reaches[i - 1])
        continue;
      const auto near = fit_near_polynomials(reach, inverse_powers, moments, wavenumber_rad_m, powers,
                                             tolerance, largest_growth);
      if (!near)
        continue;
      std::vector<Coefficients> sizes;
      fit_run({-near->largest_u, near->largest_u}, reach.farthest_m, inverse_powers, moments, powers,
              wavenumber_rad_m, &sizes);
      raise(bound.growth, value(sizes[0], std::min(near->largest_u, largest_stretch(reach))));
      raise(bound.path_terms_m, path_terms_m(sizes, reach, wavenumber_rad_m, near->largest_u));
      bound.powers = std::max(bound.powers, powers);
    }
  if (bound.powers == 0)
    return std::nullopt;
  bound.weight_error = near_weight_error(tolerance);
  bound.angle_error_rad = near_angle_error_rad(tolerance);
  return bound;
}

MomentPolynomials fit_polynomials(std::span<const PathDifference> reaches, double inverse_powers,
                                  std::uint32_t moments, double wavenumber_rad_m, double least_intensity,
                                  double tolerance) {
  if (moments > shader::largest_moments)
    return {};
  MomentPolynomials sums;
  for (const PathDifference &reach : reaches) {
    if (!sums.tables.empty() && reach == reaches[sums.tables.size() - 1]) {
      sums.tables.push_back(sums.tables.back());
      continue;
    }
    const auto shortest = shortest_run(reach, inverse_powers, moments, wavenumber_rad_m, tolerance);
    if (!shortest)
      return {};
    const auto &[powers, run] = *shortest;
    sums.powers = std::max(sums.powers, powers);
    sums.tables.push_back(run.table);
    sums.weight_error = std::max(sums.weight_error, run.weight_error);
    sums.angle_error_rad = std::max(sums.angle_error_rad, run.angle_error_rad);
    sums.growth = std::max(sums.growth, run.growth);
    sums.path_terms_m = std::max(sums.path_terms_m, run.path_terms_m);
  }
  const bool fits = std::ranges::all_of(reaches, [&](const PathDifference &reach) {
    return fits_floats(reach, inverse_powers - 2.0, sums.powers, least_intensity);
  });
  return fits ? sums : MomentPolynomials{};
}

} // namespace pmdsim
