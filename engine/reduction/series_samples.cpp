#include "engine/reduction/series_samples.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

namespace pmdsim {
namespace {

using Eigen::Index;

constexpr Index no_moment = -1;

// By the number of variables: the degree in each up to which moments are held, and points along each.
struct Resolution {
  int degree, points;
};
constexpr std::array<Resolution, 5> resolutions{{{0, 1}, {24, 72}, {12, 36}, {8, 22}, {5, 11}}};

// All moments without a.I whose polynomials are of this degree at most.
bool is_low(const Powers &powers, int degree) {
  return powers[4] == 0 && 2 * powers[0] + powers[1] + powers[2] + powers[3] <= degree;
}

// The complex coefficients of x^k in exp(j phase (sqrt(1 + x) - 1)) (1 + x)^(-s/2).
std::vector<std::complex<double>> series(double phase_rad, double s, int degree) {
  const auto size = static_cast<std::size_t>(degree) + 1;
  std::vector<double> root(size), power(size);
  std::vector<std::complex<double>> turn(size), result(size);
  power[0] = 1.0;
  turn[0] = 1.0;
  for (std::size_t k = 1; k < size; ++k) {
    const auto n = static_cast<double>(k);
    root[k] = k == 1 ? 0.5 : -root[k - 1] * (2.0 * n - 3.0) / (2.0 * n);
    power[k] = -power[k - 1] * (0.5 * s + n - 1.0) / n;
    for (std::size_t i = 1; i <= k; ++i)
      turn[k] += std::complex(0.0, phase_rad * static_cast<double>(i) / n * root[i]) * turn[k - i];
  }
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t i = 0; i <= k; ++i)
      result[k] += turn[i] * power[k - i];
  return result;
}

// Chebyshev's points of an interval; a single one where there is nothing between its ends.
std::vector<double> chebyshev_points(double from, double to, int count) {
  if (from == to)
    return {from};
  std::vector<double> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    points.push_back(0.5 * (from + to) + 0.5 * (to - from) * std::cos(std::numbers::pi * (i + 0.5) / count));
  return points;
}

double factorial(int n) { return std::tgamma(n + 1.0); }

// Where tau, up to largest_size, and the direction go. Components that no moment asks for are 0.
struct Domain {
  double largest_size;
  glm::dvec3 least{0.0}, largest{0.0};
  std::size_t variables = 1;
};

Domain domain_of(const DiodeCluster &cluster, const DirectionalBounds &seen,
                 const std::vector<Powers> &moments) {
  Domain domain{cluster.radius_m / seen.range_m};
  for (int i = 0; i < 3; ++i) {
    const auto coordinate = static_cast<std::size_t>(i) + 1;
    if (std::ranges::none_of(moments, [&](const Powers &powers) { return powers[coordinate] > 0; }))
      continue;
    domain.least[i] = seen.least[i];
    domain.largest[i] = seen.largest[i];
    if (seen.least[i] < seen.largest[i])
      ++domain.variables;
  }
  return domain;
}

std::vector<glm::dvec3> directions_of(const Domain &domain, int count) {
  std::vector<glm::dvec3> directions;
  for (const double x : chebyshev_points(domain.least.x, domain.largest.x, count))
    for (const double y : chebyshev_points(domain.least.y, domain.largest.y, count))
      for (const double z : chebyshev_points(domain.least.z, domain.largest.z, count))
        directions.emplace_back(x, y, z);
  return directions;
}

} // namespace

// A moment's coefficient: factor * in_x[degree_in_x] * tau^degree * the direction to its powers.
struct SeriesSamples::Term {
  Term(const Powers &powers, const DiodeCluster &cluster)
      : powers_of_direction{powers[1], powers[2], powers[3]},
        degree_in_x(static_cast<std::size_t>(powers[0] + powers[1] + powers[2] + powers[3])),
        degree(degree_in_x + powers[0]),
        factor(factorial(static_cast<int>(degree_in_x)) / factorial(powers[0])) {
    for (int i = 0; i < 3; ++i) {
      const int power = powers[static_cast<std::size_t>(i) + 1];
      factor *= std::pow(-2.0 * cluster.extents_m[i] / cluster.radius_m, power) / factorial(power);
    }
  }

  std::array<std::size_t, 3> powers_of_direction;
  std::size_t degree_in_x, degree;
  double factor;
};

SeriesSamples::SeriesSamples(const DiodeCluster &cluster, const DirectionalBounds &seen,
                             const ErrorScale &scale, const std::vector<Powers> &moments,
                             double least_terms) {
  for (int i = 0; i < 3; ++i)
    slants_[static_cast<std::size_t>(i)] = cluster.slant(i);
  const Domain domain = domain_of(cluster, seen, moments);
  const auto [degree, count] = resolutions[domain.variables];
  hold(moments, degree, scale.lambert);
  std::vector<Term> terms;
  for (const Index moment : held_)
    terms.emplace_back(moments[static_cast<std::size_t>(moment)], cluster);

  const double between_points =
      std::pow(std::cos(0.5 * std::numbers::pi * degree / count), -static_cast<double>(domain.variables));
  const double s = 2.0 + cluster.order.value_or(0.0) + (scale.lambert ? 1.0 : 0.0);
  const std::vector<glm::dvec3> directions = directions_of(domain, count);
  const std::vector<double> sizes = chebyshev_points(0.0, domain.largest_size, count);
  const std::size_t columns = scale.wavenumbers_rad_m.size() * sizes.size() * directions.size();
  re_.resize(static_cast<Index>(terms.size()), static_cast<Index>(columns));
  im_.resizeLike(re_);
  distance_per_im_m_.resize(static_cast<Index>(columns));
  Index column = 0;
  for (const double wavenumber_rad_m : scale.wavenumbers_rad_m)
    for (const double size : sizes) {
      const auto in_x = series(wavenumber_rad_m * cluster.radius_m / size, s, degree);
      const std::vector<double> of_size = powers_of(size, degree);
      std::vector<std::complex<double>> of_terms;
      of_terms.reserve(terms.size());
      for (const Term &term : terms)
        of_terms.push_back(between_points / least_terms * term.factor * of_size[term.degree] *
                           in_x[term.degree_in_x]);
      for (const glm::dvec3 &direction : directions) {
        distance_per_im_m_[column] = 0.5 / wavenumber_rad_m;
        set_column(column++, terms, of_terms, direction, degree);
      }
    }
}

void SeriesSamples::set_column(Index column, const std::vector<Term> &terms,
                               const std::vector<std::complex<double>> &of_size, const glm::dvec3 &direction,
                               int degree) {
  const std::array powers{powers_of(direction.x, degree), powers_of(direction.y, degree),
                          powers_of(direction.z, degree)};
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto &[x, y, z] = terms[i].powers_of_direction;
    const std::complex<double> value = of_size[i] * (powers[0][x] * powers[1][y] * powers[2][z]);
    re_(static_cast<Index>(i), column) = value.real();
    im_(static_cast<Index>(i), column) = value.imag();
  }
}

// With Lambert's law a slant adds a part of a moment's coefficient to the moment with one power more. Nothing
// is lost if that one is held only where the other is.
void SeriesSamples::hold(const std::vector<Powers> &moments, int degree, bool lambert) {
  std::vector<std::size_t> low;
  for (std::size_t i = 0; i < moments.size(); ++i)
    if (is_low(moments[i], degree))
      low.push_back(i);
  const auto power = [&](std::size_t i) { return moments[i][1] + moments[i][2] + moments[i][3]; };
  std::ranges::stable_sort(low, {}, power);
  std::map<Powers, Index> held;
  const auto lacks_lower = [&](Powers powers, std::size_t slant) {
    return slants_[slant] > 0.0 && powers[slant + 1]-- > 0 && !held.contains(powers);
  };
  for (const std::size_t i : low) {
    if (lambert && (lacks_lower(moments[i], 0) || lacks_lower(moments[i], 1) || lacks_lower(moments[i], 2)))
      continue;
    held_.push_back(static_cast<Index>(i));
    held[moments[i]] = static_cast<Index>(i);
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (const Index moment : held_) {
      Powers powers = moments[static_cast<std::size_t>(moment)];
      ++powers[i + 1];
      const auto found = held.find(powers);
      raised_[i].push_back(found == held.end() ? no_moment : found->second);
    }
}

SumError SeriesSamples::largest_error(const Eigen::VectorXd &changes, const ErrorScale &scale) const {
  const auto count = static_cast<Index>(held_.size());
  Eigen::MatrixXd of_slants = Eigen::MatrixXd::Zero(count, scale.lambert ? 4 : 1);
  for (Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    of_slants(i, 0) = changes[held_[at]];
    for (Index slant = 1; slant < of_slants.cols(); ++slant)
      if (const Index raised = raised_[static_cast<std::size_t>(slant) - 1][at]; raised != no_moment)
        of_slants(i, slant) = slants_[static_cast<std::size_t>(slant) - 1] * changes[raised];
  }
  const Eigen::ArrayXXd re = (re_.transpose() * of_slants).cwiseAbs(),
                        im = (im_.transpose() * of_slants).cwiseAbs();
  SumError largest;
  for (Index slant = of_slants.cols() > 1 ? 1 : 0; slant < of_slants.cols(); ++slant) {
    Eigen::ArrayXd all_re = re.col(0), all_im = im.col(0);
    if (slant > 0) {
      all_re += re.col(slant);
      all_im += im.col(slant);
    }
    largest.distance_m = std::max(
        largest.distance_m, (scale.distance_per_re_m * all_re + distance_per_im_m_ * all_im).maxCoeff());
    largest.amplitude = std::max(largest.amplitude, (all_re.square() + all_im.square()).maxCoeff());
  }
  largest.amplitude = std::sqrt(largest.amplitude);
  return largest;
}

} // namespace pmdsim
