#pragma once
// What sums are off by that are interpolated in cells of the view (engine/light/host/incident_field.h).

#include "engine/error_budget/plan.h"

#include <functional>

namespace pmdsim {

// The worst of single diodes' terms: their sum is off by no more.
struct FieldError {
  double relative;        // of a weight
  double path_m;          // of a path, as a distance
  double rounding_growth; // of what the nodes are off by
};

// In cells that are looked at, at random but for the edges of what is seen, with a margin for what lies
// between them. Ends where `is_enough` says so of the worst so far.
FieldError field_error(const LightFacts &view, const SourceGroups &groups, const FieldGrid &grid,
                       const std::function<bool(const FieldError &)> &is_enough);

// The bound of pixels whose sums are interpolated, from that of sums at each sample.
ErrorBound through_field(ErrorBound bound, const FieldError &error);

} // namespace pmdsim
