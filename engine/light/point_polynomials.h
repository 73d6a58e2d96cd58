#pragma once
// The sums of powers S_i (moment_polynomials.h) as polynomials of a sample's point: q is linear in the point
// and a height over the surface linear in its normal, so that all that depends on the diodes are
// coefficients. They are summed over all the diodes of a run in double beforehand, and what a sample takes
// does not depend on how many diodes there are (docs/theory.md, "Sums over the diodes, beforehand").

#include "engine/light/source_groups.h"
#include "engine/light/sum_model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim {

// The number of dimensions in which the diodes of every run stand, 2 or 3, where such polynomials do for the
// model and are shorter than the loop over the diodes; else 0.
std::uint32_t point_dimensions(const SourceGroups &groups, const SumModel &model);

// The rounding of the sums of so many powers, in units of float's, relative to their terms taken as positive:
// of a coefficient, of Horner's rule, and of the products with heights and their sum.
constexpr double beforehand_error_u(std::uint32_t powers) { return 3.0 * powers + 11.0; }

// The terms of a polynomial of a degree, and where x^j y^k z^l is among those of any: the terms of lower
// degrees first, then by the powers of y and z.
std::size_t polynomial_terms(std::uint32_t degree, std::uint32_t dimensions);
std::size_t polynomial_place(std::uint32_t j, std::uint32_t k, std::uint32_t l, std::uint32_t dimensions);

// The polynomials of all runs, one after the other, as the shader reads them (PointPolynomials in
// shaders/shared/interface.h, the coefficients behind it).
std::vector<float> point_polynomials(const SourceGroups &groups, const SumModel &model,
                                     std::uint32_t dimensions);

} // namespace pmdsim
