#pragma once
// Whether the light's field is interpolated in cells of the view (engine/light/host/incident_field.h), and
// what that comes to be off by.

#include "engine/error_budget/plan.h"
#include "engine/error_budget/typical_light.h"
#include "engine/light/interpolated_field.h"

#include <functional>
#include <optional>

namespace pmdsim {

// Of interpolation in cells of a grid.
struct FieldError {
  double relative;        // of every weight
  double path_m;          // of every path, as a distance
  double rounding_growth; // of errors at the nodes
};

// The worst of single diodes' terms in cells that are looked at, at random but for the edges of what is seen, with
// a margin for what is not; the diodes' errors come to no more in sum. Ends where `is_enough` says so.
FieldError field_error(const LightFacts &view, const SourceGroups &groups, const FieldGrid &grid,
                       const std::function<bool(const FieldError &)> &is_enough);

// The bound of pixels whose sums are interpolated, from that of sums at each sample.
ErrorBound through_field(ErrorBound bound, const FieldError &error);

// The cheapest grid that keeps the error asked for; nothing where there is none, or where sums at each sample
// take no longer. `bound`: theirs.
std::optional<InterpolatedField> plan_field(const LightFacts &view, const SourceGroups &groups,
                                       const ErrorBound &bound, const TypicalLight &typical);

} // namespace pmdsim
