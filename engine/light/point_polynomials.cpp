#include "engine/light/point_polynomials.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

namespace pmdsim {

std::size_t polynomial_terms(std::uint32_t degree, std::uint32_t dimensions) {
  const std::size_t n = degree + 1;
  return dimensions == 2 ? n * (n + 1) / 2 : n * (n + 1) * (n + 2) / 6;
}

std::size_t polynomial_place(std::uint32_t j, std::uint32_t k, std::uint32_t l, std::uint32_t dimensions) {
  const std::size_t n = j + k + l, of_y_and_z = k + l;
  return dimensions == 2 ? n * (n + 1) / 2 + k
                         : n * (n + 1) * (n + 2) / 6 + of_y_and_z * (of_y_and_z + 1) / 2 + l;
}

namespace {

// A diode's cost in the loop, in coefficients: its record's loads, and some products for each power.
constexpr std::size_t coefficients_per_diode = 6;
// The most powers for diodes that stand in no plane. Beyond that the code grows faster than it saves.
constexpr std::uint32_t most_spatial_powers = 7;
// How much the distances of a run's diodes along their axis may differ, over their radius: the rounding of
// such a distance to float.
constexpr double same_distance = 0x1p-24;

using Powers = std::array<double, shader::largest_powers>; // 1, x, x^2, ...

Powers powers_of(double x) {
  Powers result{1.0};
  for (std::size_t i = 1; i < result.size(); ++i)
    result[i] = result[i - 1] * x;
  return result;
}

double binomial(std::uint32_t n, std::uint32_t k) {
  double result = 1.0;
  for (std::uint32_t i = 1; i <= k; ++i)
    result = result * (n - k + i) / i;
  return result;
}

std::size_t run_diodes(const SourceGroups &groups) {
  return std::size_t{groups.blocks_per_run} * shader::diodes_per_block;
}

std::span<const shader::GroupSource> diodes_of(const SourceGroups &groups, const SourceRun &run) {
  return std::span(groups.diodes).subspan(run.first, run_diodes(groups));
}

// One power of one factor along the axis is common to all diodes where these stand at one distance along it.
bool share_an_axis(const SourceGroups &groups, const SourceRun &run) {
  const auto diodes = diodes_of(groups, run);
  const auto same = [&](const shader::GroupSource &diode) {
    return diode.intensity == 0.0f ||
           (glm::vec3(diode.axis) == glm::vec3(diodes.front().axis) &&
            std::abs(static_cast<double>(diode.axis.w) - static_cast<double>(diodes.front().axis.w)) <=
                same_distance * run.reach.radius_m);
  };
  return std::ranges::all_of(diodes, same);
}

// The components of heights over a surface: the reference's, and the part of a diode's place along each axis.
std::size_t components_of(const SumModel &model, std::uint32_t dimensions) {
  return model.backscatter == shader::backscatter_lambert ? 1 + dimensions : 1;
}

std::size_t coefficients_of(const SourceGroups &groups, const SumModel &model, std::uint32_t dimensions) {
  std::size_t terms = 0;
  for (std::uint32_t degree = 0; degree < groups.polynomials.powers; ++degree)
    terms += polynomial_terms(degree, dimensions);
  return terms * components_of(model, dimensions);
}

// A diode's part in the coefficients of S_0, S_1, ... of all components.
struct Term {
  double constant; // of q, as a polynomial of the point, over the unit's square
  glm::dvec3 slope;
  std::array<double, 4> weights; // of the components
};

void add_power(const Term &term, std::uint32_t power, std::uint32_t dimensions, std::span<double> to,
               std::size_t components) {
  const Powers constant = powers_of(term.constant), x = powers_of(term.slope.x), y = powers_of(term.slope.y),
               z = powers_of(term.slope.z);
  for (std::uint32_t l = 0; l <= (dimensions == 3 ? power : 0); ++l)
    for (std::uint32_t k = 0; k + l <= power; ++k)
      for (std::uint32_t j = 0; j + k + l <= power; ++j) {
        const double value = binomial(power, l) * binomial(power - l, k) * binomial(power - l - k, j) *
                             constant[power - j - k - l] * x[j] * y[k] * z[l];
        for (std::size_t component = 0; component < components; ++component)
          to[polynomial_place(j, k, l, dimensions) * components + component] +=
              value * term.weights[component];
      }
}

// A power of two, so that lengths in it are as exact as in metres, and no power of them leaves float's range.
double unit_of(const SourceRun &run) {
  return run.reach.radius_m > 0.0 ? std::exp2(std::ceil(std::log2(run.reach.radius_m))) : 1.0;
}

std::vector<double> coefficients(const SourceGroups &groups, const SumModel &model, const SourceRun &run,
                                 std::uint32_t dimensions) {
  const std::size_t components = components_of(model, dimensions);
  const double unit = unit_of(run);
  std::vector<double> sums(coefficients_of(groups, model, dimensions));
  for (std::size_t i = run.first; i < run.first + run_diodes(groups); ++i) {
    const auto intensity = static_cast<double>(groups.diodes[i].intensity);
    if (intensity == 0.0)
      continue;
    const glm::dvec3 place = (groups.positions[i].position_m - run.reference_m) / unit;
    const Term term{glm::dot(place, place),
                    -2.0 * place,
                    {intensity, intensity * place.x, intensity * place.y, intensity * place.z}};
    std::span<double> left = sums;
    for (std::uint32_t power = 0; power < groups.polynomials.powers; ++power) {
      const std::size_t of_power = polynomial_terms(power, dimensions) * components;
      add_power(term, power, dimensions, left.first(of_power), components);
      left = left.subspan(of_power);
    }
  }
  return sums;
}

} // namespace

std::uint32_t point_dimensions(const SourceGroups &groups, const SumModel &model) {
  const bool knows_law = model.pattern == shader::pattern_isotropic || model.pattern == shader::pattern_power;
  if (!knows_law || groups.polynomials.powers == 0 || groups.diodes.empty())
    return 0;
  if (model.pattern == shader::pattern_power &&
      !std::ranges::all_of(groups.runs, [&](const SourceRun &run) { return share_an_axis(groups, run); }))
    return 0;
  const std::uint32_t dimensions = groups.polynomials.coplanar ? 2 : 3;
  const bool is_short =
      coefficients_of(groups, model, dimensions) <= coefficients_per_diode * run_diodes(groups);
  return is_short && (dimensions == 2 || groups.polynomials.powers <= most_spatial_powers) ? dimensions : 0;
}

std::vector<float> point_polynomials(const SourceGroups &groups, const SumModel &model,
                                     std::uint32_t dimensions) {
  std::vector<float> result;
  for (const SourceRun &run : groups.runs) {
    const auto unit = static_cast<float>(unit_of(run));
    const shader::PointPolynomials head{groups.diodes[run.first].axis, 1.0f / unit, unit, unit * unit, 0.0f};
    const auto words = std::bit_cast<std::array<float, sizeof(head) / sizeof(float)>>(head);
    result.insert(result.end(), words.begin(), words.end());
    for (const double coefficient : coefficients(groups, model, run, dimensions))
      result.push_back(static_cast<float>(coefficient));
    result.resize((result.size() + 3) / 4 * 4); // runs begin at whole vectors
  }
  return result;
}

} // namespace pmdsim
