#pragma once
// The groups of sources that a plan sums, and how short an error lets their series be.

#include "engine/error_budget/plan.h"

#include <vector>

namespace pmdsim {

std::vector<double> wavenumbers_rad_m(const Modulation &modulation);

// What `share` of the error asked for lets series leave out of a sum (SourceGroups::tolerance); nothing in
// double.
double tolerance_of(const LightFacts &view, Precision precision, const Accuracy &accuracy, double share);

// Tables in place of roots let rounding grow, and more so where weights fall fast: high powers of 1 / r take
// roots, or tables where the error asked for leaves room.
enum class HighPowers { by_roots, by_tables };
bool has_high_powers(const LightFacts &view);

// `tolerance`: of series, over the growth by which such errors count.
SourceGroups groups_of(const LightFacts &view, const std::vector<CameraIlluminator> &lights,
                       Precision precision, double tolerance = 0.0, HighPowers high = HighPowers::by_roots);

// The factor by which rounding grows at most, where powers stand for roots.
double growth_of(const SourceGroups &groups);

} // namespace pmdsim
