#pragma once
// The groups of sources that a plan sums, and how short an error lets their series be.

#include "engine/error_budget/plan.h"

#include <vector>

namespace pmdsim {

std::vector<double> wavenumbers_rad_m(const Modulation &modulation);

// What `share` of the error asked for lets series leave out of a sum (SourceGroups::tolerance); nothing in
// double.
double tolerance_of(const LightFacts &view, Precision precision, const Accuracy &accuracy, double share);

// `tolerance`: of series, over the growth by which such errors count. `near_growth`: of tables that stand for
// roots; 1: there are none.
SourceGroups groups_of(const LightFacts &view, const std::vector<CameraIlluminator> &lights,
                       Precision precision, double tolerance = 0.0, double near_growth = largest_near_growth);

// The factor by which rounding grows at most, where powers stand for roots.
double growth_of(const SourceGroups &groups);

} // namespace pmdsim
