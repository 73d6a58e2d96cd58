#pragma once
// The bounds of the sums that a plan may take.

#include "engine/error_budget/plan.h"
#include "engine/error_budget/rounding_bound.h"
#include "engine/reduction/reduced_set.h"

#include <optional>

namespace pmdsim {

// How groups are summed, and for which pixels.
struct PlannedSum {
  Precision precision;
  std::uint32_t samples = 1;                            // S
  std::optional<double> sample_spread_m = std::nullopt; // as in RoundingScope
  bool beforehand = false;                              // likewise
  bool knows_pixels = true; // beams' errors are bounded pixel by pixel, else before the frame
};

// Where light grazes a surface or a beam ends, the pixel's terms have its rounding. Nothing as
// rounding_bound.
std::optional<RoundingBound> bound_of(const LightFacts &view, const SourceGroups &groups,
                                      const PlannedSum &sum);

// The same for pixels whose samples are at one range; nothing where there is only one sample.
std::optional<RoundingBound> at_one_range(const LightFacts &view, const SourceGroups &groups, PlannedSum sum);

// What the sum of `light` comes to be off by. `at_one_range`: the rounding of pixels whose samples are at one
// range.
ErrorBound error_bound_of(const Accuracy &accuracy, const RoundingBound &rounding, const ReducedLight &light,
                          const std::optional<RoundingBound> &at_one_range = std::nullopt);

// The bound of pixels of which some keep the one bound and some the other.
ErrorBound worse_of(ErrorBound a, const ErrorBound &b);

} // namespace pmdsim
