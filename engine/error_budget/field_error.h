#pragma once
// What sums are off by that are interpolated in cells of the view (engine/light/host/incident_field.h).

#include "engine/error_budget/field_cells.h"
#include "engine/error_budget/plan.h"

#include <functional>

namespace pmdsim {

// The worst of single diodes' terms: their sum is off by no more.
struct FieldError {
  double relative;        // of a weight
  double path_m;          // of a path, as a distance
  double rounding_growth; // of what the nodes are off by
  double dimming;         // of a cell's dimmest node below a place of it, ln
};

// `beams`: of each run, which the sums are divided by. At places that are looked at, with a margin for what
// lies between them. Ends where `is_too_large` says so of the worst so far. Infinite where nothing is seen,
// or where there are too many kinds of diodes to look at.
FieldError field_error(const LightFacts &view, const SourceGroups &groups,
                       const std::vector<FieldBeam> &beams, const FieldCells &cells,
                       const std::function<bool(const FieldError &)> &is_too_large);

// The bound of pixels whose sums are interpolated, from that of sums at each sample.
ErrorBound through_field(ErrorBound bound, const FieldError &error, double wavenumber_rad_m);

} // namespace pmdsim
