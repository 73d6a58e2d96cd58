#pragma once
// The groups of sources that a plan sums, and how short an error lets their series be.

#include "engine/error_budget/plan.h"

#include <vector>

namespace pmdsim {

std::vector<double> wavenumbers_rad_m(const Modulation &modulation);

// What `share` of the error asked for lets series leave out of a sum (SourceGroups::tolerance); nothing in
// double.
double tolerance_of(const LightFacts &view, Precision precision, const Accuracy &accuracy, double share);

// Which powers of 1 / r tables may stand for: they let rounding grow, and more so where weights fall fast.
enum class NearTables { none, of_low_powers, of_any_powers };
bool has_high_powers(const LightFacts &view);

// `tolerance`: of series, over the growth by which such errors count.
SourceGroups groups_of(const LightFacts &view, const std::vector<CameraIlluminator> &lights,
                       Precision precision, double tolerance = 0.0,
                       NearTables tables = NearTables::of_low_powers);

// The factor by which rounding grows at most, where powers stand for roots.
double growth_of(const SourceGroups &groups);

} // namespace pmdsim
