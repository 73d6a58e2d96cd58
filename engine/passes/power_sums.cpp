#include "engine/passes/power_sums.h"

#include "engine/accuracy.h"
#include "engine/passes/remainder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

constexpr std::uint32_t most_powers = shader::largest_powers;
constexpr std::uint32_t probes = 97; // where errors are looked for; between the zeros of any of the polynomials

// Of the cosines that a weight's factors are, the least that matters (shaders/sum.glsl: where beams end).
constexpr double least_cosine = 1e-4;
constexpr double smallest_float = 1e-30, largest_float = 1e36; // what is much smaller than others does not count

// Of u.
struct Interval {
  double low, high;

  double at(double t) const { return 0.5 * (low + high) + 0.5 * (high - low) * t; } // t from -1 to 1
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

// A hair wider, as the shader's u is rounded; never empty.
Interval interval_of(const Excess &reach) {
  constexpr double rounding = 1e-6;
  return {reach.least_stretch - rounding, reach.most_stretch + rounding};
}

double moment_factor(double u, std::uint32_t inverse_powers, std::uint32_t k) {
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
Coefficients interpolate(const Interval &interval, std::uint32_t inverse_powers, std::uint32_t k,
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

// Of one moment, at most, over the interval.
struct Fit {
  double error = 0.0, largest = 0.0; // of the polynomial; of what it stands for
  double terms = 0.0;                // sum_i |a_i u^i|
};

Fit judge(const Coefficients &a, const Interval &interval, std::uint32_t inverse_powers, std::uint32_t k) {
  Fit fit;
  for (std::uint32_t i = 0; i < probes; ++i) {
    const double u = interval.at(std::cos(std::numbers::pi * i / (probes - 1)));
    const double exact = moment_factor(u, inverse_powers, k);
    fit.error = std::max(fit.error, std::abs(value(a, u) - exact));
    fit.largest = std::max(fit.largest, std::abs(exact));
  }
  Coefficients sizes{};
  std::ranges::transform(a, sizes.begin(), [](double coefficient) { return std::abs(coefficient); });
  fit.terms = value(sizes, interval.largest());
  return fit;
}

// A run's polynomials, judged.
class Run {
public:
  Run(const Excess &reach, std::uint32_t inverse_powers, std::uint32_t moments, std::uint32_t powers,
      double wavenumber_rad_m)
      : table_{} {
    const Interval interval = interval_of(reach);
    const double least = moment_factor(interval.high, inverse_powers, 0); // of a weight
    double phase_power = 1.0; // (kappa rho)^k / k!
    for (std::uint32_t k = 0; k < moments; ++k) {
      const Coefficients a = interpolate(interval, inverse_powers, k, powers);
      for (std::uint32_t i = 0; i < powers; ++i)
        table_[shader::largest_powers / 4 * k + i / 4][static_cast<int>(i % 4)] = static_cast<float>(a[i]);
      const Fit fit = judge(a, interval, inverse_powers, k);
      growth_ = std::max(growth_, fit.terms / fit.largest);
      (k == 0 ? weight_error_ : angle_error_rad_) += phase_power * fit.error / least;
      phase_power *= wavenumber_rad_m * reach.farthest_m / (k + 1);
    }
  }

  const PowerSums::Table &table() const { return table_; }
  double weight_error() const { return weight_error_; }
  double angle_error_rad() const { return angle_error_rad_; }
  double growth() const { return growth_; }

private:
  PowerSums::Table table_;
  double weight_error_ = 0.0, angle_error_rad_ = 0.0, growth_ = 1.0;
};

bool is_exact_enough(const Run &run, double phase_rad) {
  const double remainder = largest_remainder(Precision::fp32);
  return run.weight_error() <= remainder && run.angle_error_rad() <= largest_term(phase_rad, remainder);
}

// W is a product of lengths, each a range times a cosine; q = u rho^2.
bool fits_floats(const Excess &reach, std::uint32_t lengths, std::uint32_t powers) {
  const double near_m = std::min(1.0, reach.range_m - reach.radius_m);
  const double far_m = std::max(1.0, reach.farthest_m + reach.radius_m);
  const double of_q = std::max(2.0 * (powers - 1.0), 2.0);
  return std::pow(near_m * least_cosine, lengths) * std::pow(near_m, of_q) > smallest_float &&
         std::pow(far_m, lengths + of_q) < largest_float;
}

} // namespace

PowerSums power_sums(std::span<const Excess> reaches, std::uint32_t inverse_powers, std::uint32_t moments,
                     double wavenumber_rad_m) {
  if (moments > shader::largest_moments ||
      !std::ranges::all_of(reaches, [&](const Excess &reach) {
        return std::isfinite(reach.most_stretch);
      }))
    return {};
  for (std::uint32_t powers = 1; powers <= most_powers; ++powers) {
    PowerSums sums;
    sums.powers = powers;
    for (const Excess &reach : reaches) {
      if (sums.tables.size() > 0 && reach == reaches[sums.tables.size() - 1]) {
        sums.tables.push_back(sums.tables.back());
        continue;
      }
      if (!fits_floats(reach, inverse_powers - 2, powers))
        return {};
      const Run run(reach, inverse_powers, moments, powers, wavenumber_rad_m);
      if (!is_exact_enough(run, wavenumber_rad_m * reach.excess_m))
        break;
      sums.tables.push_back(run.table());
      sums.weight_error = std::max(sums.weight_error, run.weight_error());
      sums.angle_error_rad = std::max(sums.angle_error_rad, run.angle_error_rad());
      sums.growth = std::max(sums.growth, run.growth());
    }
    if (sums.tables.size() == reaches.size())
      return sums;
  }
  return {};
}

} // namespace pmdsim
