#pragma once
// The rounding of a single term of a sum, operation by operation, in units u (engine/light/rounding_units.h):
// of its weight and of its path. How the sum is taken decides, by roots or by polynomials
// (SourceGroups::polynomials).

#include "engine/error_budget/rounding_bound.h"
#include "engine/light/radiation_laws.h"

namespace pmdsim {

// How the groups' radiation laws are taken.
LawRounding law_rounding(const SourceGroups &groups, const SumModel &model, const RoundingScope &scope);

// Of I J cos / r^2, relative, u.
double weight_error(const SourceGroups &groups, const SumModel &model, const RoundingScope &scope);

// Of e = q / (r + rho), m over u: the rounding of q, R the largest radius, and the rest.
double excess_error_m(const SourceGroups &groups, const RoundingScope &scope);

} // namespace pmdsim
