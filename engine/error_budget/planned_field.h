#pragma once
// Whether sums over the sources are interpolated in cells of the view (engine/light/host/incident_field.h).

#include "engine/error_budget/plan.h"

#include <optional>

namespace pmdsim {

// The largest cells that keep the error asked for in most pixels; nothing where there are none, or where sums
// at each sample take no longer. `bound`: theirs.
std::optional<InterpolatedField> plan_field(const LightFacts &view, const SourceGroups &groups,
                                            const ErrorBound &bound);

} // namespace pmdsim
