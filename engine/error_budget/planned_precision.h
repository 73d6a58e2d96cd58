#pragma once
// The precision in which a plan sums all diodes.

#include "engine/error_budget/plan.h"
#include "engine/error_budget/rounding_bound.h"
#include "engine/error_budget/typical_light.h"

namespace pmdsim {

// All diodes as they are summed in a precision, and what rounding may do to that.
struct RoundedSum {
  Precision precision;
  SourceGroups groups;
  RoundingBound bound;
};

// The share that series of fewer terms may take in each plan.
inline constexpr double share_of_series[frame_plans] = {0.01, 0.006, 0.0};

// In the cheapest precision from the `attempt`-th plan on that leaves something of the error asked for.
// Throws Error (accuracy) where none does.
RoundedSum choose_precision(const LightFacts &view, const Accuracy &accuracy, const TypicalLight &typical,
                            std::uint32_t attempt);

} // namespace pmdsim
