#include "engine/error_budget/term_rounding.h"

#include "engine/light/point_polynomials.h"
#include "engine/light/rounding_units.h"

#include <algorithm>

namespace pmdsim {

LawRounding law_rounding(const SourceGroups &groups, const SumModel &model, const RoundingScope &scope) {
  return {model.pattern, groups.radius_over_range,
          scope.beam_edges_are_terms ? beam_cosine : scope.emission_cosine, scope.beams_are_terms};
}

namespace {

// The rounding of q / rho^2, u: |q| <= 2 rho R + R^2 has six roundings in its larger part and three in its
// smaller; 1 / rho^2 is a product and a division of the rounded rho.
constexpr double inverse_square = division_u + 3.0;
double stretch_error(double t) { return 12.0 * t + 3.0 * t * t + inverse_square * (2.0 * t + t * t); }

// The rounding of a polynomial's terms, u: the i-th takes i products in the loop over the diodes, then i
// times 1 / rho^2 and as many sums. Summed beforehand, a coefficient is rounded, and in place of the loop's
// products come those of the point's coordinates, two sums and a product each, and for heights the sum over
// the axes.
double polynomial_error(const SourceGroups &groups, const RoundingScope &scope) {
  if (scope.beforehand)
    return beforehand_error_u(groups.polynomials.powers) + 2.0 * groups.polynomials.powers;
  // The host may take one or two more.
  const std::vector<std::uint32_t> near = near_powers(groups.polynomials.powers);
  return 3.0 * *std::ranges::lower_bound(near, groups.polynomials.powers);
}

// As weight_error, by powers of u (moment_polynomials.h): its factors, the polynomial, and u in (1 +
// u)^(-p/2).
double power_weight_error(const SourceGroups &groups, const SumModel &model, const RoundingScope &scope,
                          double inverse_powers) {
  const auto [form, t, least_cosine, beams_are_apart] = law_rounding(groups, model, scope);
  double error = 4.0 + inverse_square + (inverse_powers - 2.0) * (division_u + 2.0) +
                 polynomial_error(groups, scope) +
                 0.5 * inverse_powers * stretch_error(t) / ((1.0 - t) * (1.0 - t));
  if (model.pattern == shader::pattern_power)
    error += model.order * (along_error_u(t) / least_cosine + 1.0) +
             fraction_error_u(model.order, t, least_cosine);
  else
    error += law_rounding_u(groups.diodes, law_rounding(groups, model, scope));
  if (model.backscatter == shader::backscatter_lambert)
    error += 2.0 + cosine_error_u(9.0 + 5.0 * t, t) / scope.incidence_cosine;
  return error;
}

} // namespace

double weight_error(const SourceGroups &groups, const SumModel &model, const RoundingScope &scope) {
  const double t = groups.radius_over_range, r2 = squared_range_error_u(t);
  if (groups.polynomials.powers > 0)
    return power_weight_error(groups, model, scope, inverse_powers(model));
  const double inverse_square_u = std::max(division_u + 4.0, 2.0 * (host_root_u + 1.0) + 6.0);
  double error = r2 + inverse_square_u + law_rounding_u(groups.diodes, law_rounding(groups, model, scope));
  if (model.backscatter == shader::backscatter_lambert)
    error += 0.5 * r2 + root_u + division_u + 6.0 + cosine_error_u(9.0 + 5.0 * t, t) / scope.incidence_cosine;
  return error;
}

double excess_error_m(const SourceGroups &groups, const RoundingScope &scope) {
  const double t = groups.radius_over_range;
  if (groups.polynomials.powers > 0) // of rho (sqrt(1 + u) - 1), and of the polynomial
    return groups.radius_m * (6.0 + 1.5 * t) / (1.0 - t) +
           groups.polynomials.path_terms_m * (polynomial_error(groups, scope) + 3.0) +
           groups.path_difference_m * inverse_square / (1.0 - t);
  return groups.radius_m * (12.0 + 2.0 * t) / (2.0 - t) +
         groups.path_difference_m * (0.25 * squared_range_error_u(t) + 0.5 * root_u + division_u + 4.5);
}

} // namespace pmdsim
