#include "engine/reduction/dominant_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace pmdsim {
namespace {

constexpr double largest_x = 0.75;           // of |x|
constexpr double largest_beam_step = 0.5;    // of |a.I| / a.P
constexpr double largest_beam_change = 10.0; // of order * |a.I| / a.P
constexpr std::size_t largest_degree = 40;   // in x
// More take too long; more than the square of the diodes, and there would be as many diodes after as before.
constexpr std::size_t most_moments = 12000;
constexpr std::size_t fewest_sampled_diodes = 100; // of a cluster
constexpr std::size_t most_sampled_frequencies = 4;
constexpr double bearable_rest = 0.05; // of the error that is bearable, for all that is left out

using Series = std::vector<double>; // coefficients

// With nonnegative coefficients that are, in absolute value, at least those of the real and the imaginary
// part of the series in y, x = largest_x y; `re_sum` and `im_sum` are the sums of all coefficients.
struct Majorant {
  Series re, im;
  double re_sum, im_sum;
};

// sqrt(1 + x) - 1 becomes 1 - sqrt(1 - x), sine and cosine hyperbolic, (1 + x)^(-s/2) becomes (1 - x)^(-s/2).
Majorant majorant(double phase_rad, double x, double s) {
  Series root(largest_degree + 1), power(largest_degree + 1), sinh(largest_degree + 1),
      cosh(largest_degree + 1);
  root[1] = 0.5 * x;
  power[0] = cosh[0] = 1.0;
  for (std::size_t k = 1; k <= largest_degree; ++k) {
    const auto n = static_cast<double>(k);
    if (k > 1)
      root[k] = root[k - 1] * x * (2.0 * n - 3.0) / (2.0 * n);
    power[k] = power[k - 1] * x * (0.5 * s + n - 1.0) / n;
    for (std::size_t i = 1; i <= k; ++i) { // (sinh u)' = u' cosh u and the other way round
      const double slope = phase_rad * static_cast<double>(i) * root[i] / n;
      sinh[k] += slope * cosh[k - i];
      cosh[k] += slope * sinh[k - i];
    }
  }
  const double all = phase_rad * x / (1.0 + std::sqrt(1.0 - x)), all_power = std::pow(1.0 - x, -0.5 * s);
  Majorant result{Series(largest_degree + 1), Series(largest_degree + 1), std::cosh(all) * all_power,
                  std::sinh(all) * all_power};
  for (std::size_t k = 0; k <= largest_degree; ++k)
    for (std::size_t i = 0; i <= k; ++i) {
      result.re[k] += cosh[i] * power[k - i];
      result.im[k] += sinh[i] * power[k - i];
    }
  return result;
}

// |binomial(order, j)| z^j, until they are below rounding; their sum.
struct BeamSeries {
  Series coefficients;
  double sum = 0.0;
};

BeamSeries beam_series(double order, double z) {
  BeamSeries result;
  double coefficient = 1.0;
  for (double j = 0.0; coefficient > 1e-20 || (order - j) * z > 0.5 * (j + 1.0); ++j) {
    result.sum += coefficient;
    if (result.coefficients.size() <= largest_degree)
      result.coefficients.push_back(coefficient);
    coefficient *= std::abs(order - j) / (j + 1.0) * z;
  }
  return result;
}

// A direction's power series: bounds of all coefficients, over a bound of sum|terms| from below.
struct SightSeries {
  Majorant in_x;
  BeamSeries in_beam;
  std::array<Series, 4> shares; // powers of the parts of x: by |I|^2 and by each coordinate; their sum is 1
  double least_terms;
};

std::optional<SightSeries> series_of(const DiodeCluster &cluster, const DirectionalBounds &direction,
                                     const ErrorScale &scale) {
  const double order = cluster.order.value_or(0.0);
  const double s = 2.0 + order + (scale.lambert ? 1.0 : 0.0);
  const double size = cluster.radius_m / direction.range_m;
  const glm::dvec3 slopes = glm::max(glm::abs(direction.least), glm::abs(direction.largest));
  std::array<double, 4> parts{size * size};
  for (int i = 0; i < 3; ++i)
    parts[static_cast<std::size_t>(i) + 1] = 2.0 * cluster.extents_m[i] * slopes[i] / direction.range_m;
  const double x = std::accumulate(parts.begin(), parts.end(), 0.0);
  if (!(x <= largest_x))
    return std::nullopt;
  double z = 0.0;
  if (cluster.order) {
    z = cluster.beam_extent_m / (direction.beam_cosine * direction.range_m);
    if (!(direction.beam_cosine > 0.0) || !(z <= largest_beam_step) || order * z > largest_beam_change)
      return std::nullopt;
  }
  SightSeries series{majorant(scale.largest_wavenumber_rad_m() * direction.range_m, x, s),
                     beam_series(order, z),
                     {},
                     std::pow(1.0 + x, -0.5 * s) * std::pow(1.0 - z, order)};
  if (!(series.least_terms > 0.0) ||
      !std::isfinite(series.in_x.re_sum * series.in_beam.sum / series.least_terms))
    return std::nullopt;
  for (std::size_t part = 0; part < parts.size(); ++part) { // p^k / k!, for the multinomial
    Series &powers = series.shares[part];
    powers.assign(largest_degree + 1, 0.0);
    powers[0] = 1.0;
    for (std::size_t k = 1; k <= largest_degree && x > 0.0; ++k)
      powers[k] = powers[k - 1] * parts[part] / x / static_cast<double>(k);
  }
  return series;
}

struct Coefficient {
  double re = 0.0, im = 0.0;
};

// By powers, one for each direction.
using Coefficients = std::map<Powers, std::vector<Coefficient>>;

// Where surfaces are Lambertian, each direction comes three times: with a surface that is as slanted as may
// be towards each of the axes. (Others are between them.)
std::size_t slants(const ErrorScale &scale) { return scale.lambert ? 3 : 1; }

class Enumeration {
public:
  Enumeration(const DiodeCluster &cluster, const std::vector<SightSeries> &series, const ErrorScale &scale)
      : cluster_(cluster), series_(series), scale_(scale) {}

  // Nothing where they are more than `most`, about.
  std::optional<Coefficients> all(std::size_t most) {
    double factorial = 1.0;
    for (std::size_t degree = 0; degree <= largest_degree; factorial *= static_cast<double>(++degree))
      for (std::size_t a = 0; a <= degree; ++a)
        for (std::size_t i = 0; i + a <= degree; ++i) {
          for (std::size_t j = 0; i + j + a <= degree; ++j)
            add({a, i, j, degree - a - i - j}, degree, factorial);
          if (result_.size() > most)
            return std::nullopt;
        }
    return std::move(result_);
  }

private:
  void add(const std::array<std::size_t, 4> &powers, std::size_t degree, double factorial) {
    std::vector<double> shares;
    std::size_t beam_powers = 0;
    for (const SightSeries &series : series_) {
      double share = factorial / series.least_terms;
      for (std::size_t part = 0; part < powers.size(); ++part)
        share *= series.shares[part][powers[part]];
      shares.push_back(share);
      if (share > 0.0)
        beam_powers = std::max(beam_powers, series.in_beam.coefficients.size());
    }
    for (std::size_t beam_power = 0; beam_power < beam_powers; ++beam_power) {
      std::vector<Coefficient> coefficients(series_.size());
      double largest = 0.0;
      for (std::size_t direction = 0; direction < series_.size(); ++direction) {
        const SightSeries &series = series_[direction];
        if (beam_power >= series.in_beam.coefficients.size())
          continue;
        const double share = shares[direction] * series.in_beam.coefficients[beam_power];
        coefficients[direction] = {share * series.in_x.re[degree], share * series.in_x.im[degree]};
        largest = std::max(largest, scale_.excess(coefficients[direction].re, coefficients[direction].im));
      }
      if (largest >= negligible)
        add({static_cast<std::uint8_t>(powers[0]), static_cast<std::uint8_t>(powers[1]),
             static_cast<std::uint8_t>(powers[2]), static_cast<std::uint8_t>(powers[3]),
             static_cast<std::uint8_t>(beam_power)},
            coefficients);
    }
  }

  void add(const Powers &powers, const std::vector<Coefficient> &coefficients) {
    for (std::size_t slant = 0; slant < slants(scale_); ++slant) {
      add(powers, slant, 1.0, coefficients);
      const double slanted = scale_.lambert ? cluster_.slant(static_cast<int>(slant)) : 0.0;
      if (slanted > 0.0) {
        Powers raised = powers;
        ++raised[slant + 1];
        add(raised, slant, slanted, coefficients);
      }
    }
  }

  void add(const Powers &powers, std::size_t slant, double factor, const std::vector<Coefficient> &more) {
    std::vector<Coefficient> &sum =
        result_.try_emplace(powers, series_.size() * slants(scale_)).first->second;
    for (std::size_t direction = 0; direction < more.size(); ++direction) {
      Coefficient &to = sum[direction * slants(scale_) + slant];
      to.re += factor * more[direction].re;
      to.im += factor * more[direction].im;
    }
  }

  // Over the bearable error: thousands of such moments are nothing.
  static constexpr double negligible = 1e-7;

  const DiodeCluster &cluster_;
  const std::vector<SightSeries> &series_;
  const ErrorScale &scale_;
  Coefficients result_;
};

double largest_excess(const std::vector<Coefficient> &coefficients, const ErrorScale &scale) {
  double largest = 0.0;
  for (const Coefficient &c : coefficients)
    largest = std::max(largest, scale.excess(c.re, c.im));
  return largest;
}

// Erases the moments that matter least.
void leave_out_the_least(Coefficients &coefficients, const ErrorScale &scale) {
  std::vector<double> by_excess;
  for (const auto &[powers, of_sights] : coefficients)
    by_excess.push_back(largest_excess(of_sights, scale));
  std::ranges::sort(by_excess);
  double sum = 0.0, least = 0.0;
  for (const double excess : by_excess) {
    sum += 2.0 * excess;
    if (sum > 0.5 * bearable_rest)
      break;
    least = excess;
  }
  std::erase_if(coefficients,
                [&](const auto &moment) { return largest_excess(moment.second, scale) <= least; });
}

// Sets the rest: the part of all coefficients' sum that the moments do not have; twice, for the weights
// before and after.
void set_rest(MomentBounds &bounds, const DiodeCluster &cluster, const std::vector<SightSeries> &series,
              const ErrorScale &scale) {
  bounds.rest_re = -2.0 * bounds.re.rowwise().sum();
  bounds.rest_im = -2.0 * bounds.im.rowwise().sum();
  constexpr double rounding = 1e-15;
  for (Eigen::Index i = 0; i < bounds.re.rows(); ++i) {
    const SightSeries &direction = series[static_cast<std::size_t>(i) / slants(scale)];
    const double slanted = scale.lambert ? 1.0 + cluster.slant(static_cast<int>(i % 3)) : 1.0;
    const double factor = 2.0 * (1.0 + rounding) * slanted * direction.in_beam.sum / direction.least_terms;
    bounds.rest_re[i] = std::max(0.0, bounds.rest_re[i] + factor * direction.in_x.re_sum);
    bounds.rest_im[i] = std::max(0.0, bounds.rest_im[i] + factor * direction.in_x.im_sum);
  }
}

MomentBounds bounds_of(const Coefficients &coefficients, const DiodeCluster &cluster,
                       const std::vector<SightSeries> &series, const ErrorScale &scale) {
  const auto moments = static_cast<Eigen::Index>(coefficients.size());
  const auto directions = static_cast<Eigen::Index>(series.size() * slants(scale));
  MomentBounds bounds;
  bounds.re.resize(directions, moments);
  bounds.im.resize(directions, moments);
  Eigen::Index moment = 0;
  for (const auto &[powers, of_sights] : coefficients) {
    for (Eigen::Index direction = 0; direction < directions; ++direction) {
      bounds.re(direction, moment) = of_sights[static_cast<std::size_t>(direction)].re;
      bounds.im(direction, moment) = of_sights[static_cast<std::size_t>(direction)].im;
    }
    bounds.moments.push_back(powers);
    ++moment;
  }
  set_rest(bounds, cluster, series, scale);
  return bounds;
}

SumError largest_of(const std::vector<SumError> &errors) {
  SumError largest;
  for (const SumError &error : errors) {
    largest.distance_m = std::max(largest.distance_m, error.distance_m);
    largest.amplitude = std::max(largest.amplitude, error.amplitude);
  }
  return largest;
}

} // namespace

std::vector<SumError> MomentBounds::errors(const Eigen::VectorXd &sizes, const ErrorScale &scale) const {
  const Eigen::VectorXd all_re = re * sizes + rest_re, all_im = im * sizes + rest_im;
  std::vector<SumError> result;
  for (Eigen::Index i = 0; i < all_re.size(); ++i)
    result.push_back({scale.distance_m(all_re[i], all_im[i]), std::hypot(all_re[i], all_im[i])});
  return result;
}

Eigen::VectorXd MomentBounds::importance(const ErrorScale &scale) const {
  Eigen::VectorXd result(re.cols());
  for (Eigen::Index moment = 0; moment < re.cols(); ++moment) {
    double largest = 0.0;
    for (Eigen::Index direction = 0; direction < re.rows(); ++direction)
      largest = std::max(largest, scale.excess(re(direction, moment), im(direction, moment)));
    result[moment] = largest;
  }
  return result;
}

SumError MomentBounds::error(const Eigen::VectorXd &changes, const ErrorScale &scale) const {
  const Eigen::VectorXd sizes = changes.cwiseAbs();
  const std::vector<SumError> one_by_one = errors(sizes, scale);
  if (samples.empty())
    return largest_of(one_by_one);
  Eigen::VectorXd others = sizes;
  for (const Eigen::Index moment : samples.front().held())
    others[moment] = 0.0;
  std::vector<SumError> least = errors(others, scale);
  SumError together;
  const std::size_t slants = least.size() / samples.size();
  for (std::size_t i = 0; i < least.size(); ++i) {
    if (i % slants == 0)
      together = samples[i / slants].largest_error(changes, scale);
    least[i].distance_m = std::min(one_by_one[i].distance_m, least[i].distance_m + together.distance_m);
    least[i].amplitude = std::min(one_by_one[i].amplitude, least[i].amplitude + together.amplitude);
  }
  return largest_of(least);
}

bool converges(const DiodeCluster &cluster, const std::vector<DirectionalBounds> &directions,
               const ErrorScale &scale) {
  return std::ranges::all_of(directions, [&](const DirectionalBounds &direction) {
    return series_of(cluster, direction, scale).has_value();
  });
}

std::optional<MomentBounds> dominant_moments(const DiodeCluster &cluster,
                                             const std::vector<DirectionalBounds> &directions,
                                             const ErrorScale &scale) {
  std::vector<SightSeries> series;
  for (const DirectionalBounds &direction : directions) {
    std::optional<SightSeries> of_sight = series_of(cluster, direction, scale);
    if (!of_sight)
      return std::nullopt;
    series.push_back(std::move(*of_sight));
  }
  const std::size_t diodes = cluster.offsets_m.size();
  std::optional<Coefficients> coefficients =
      Enumeration(cluster, series, scale).all(std::min(most_moments, diodes * diodes));
  if (!coefficients)
    return std::nullopt;
  leave_out_the_least(*coefficients, scale);
  MomentBounds bounds = bounds_of(*coefficients, cluster, series, scale);
  for (Eigen::Index direction = 0; direction < bounds.rest_re.size(); ++direction)
    if (!(scale.excess(bounds.rest_re[direction], bounds.rest_im[direction]) <= bearable_rest))
      return std::nullopt;
  if (cluster.offsets_m.size() >= fewest_sampled_diodes && cluster.radius_m > 0.0 &&
      scale.wavenumbers_rad_m.size() <= most_sampled_frequencies)
    for (std::size_t i = 0; i < directions.size(); ++i)
      bounds.samples.emplace_back(cluster, directions[i], scale, bounds.moments, series[i].least_terms);
  return bounds;
}

} // namespace pmdsim
