#pragma once
// The uniform-pixel pass: pixels of one surface that every diode lights, from their IDs to their channels at
// once, at one point or, in a pass of its own, at four. The others are listed (pixel_lists.h).

#include "engine/error_budget/plan.h"
#include "engine/light/accumulate_pass.h"
#include "engine/sampling/pixel_lists.h"

#include <memory>

namespace pmdsim {

struct UniformPixels {
  std::uint32_t points =
      0;                // at which a pixel of several samples is evaluated: none, 1, or 4 for list_refined
  bool refines = false; // pixels for which one point is not enough are listed for four
  bool sums = true;     // false: the pass only lists pixels
  bool lists = true;    // false: it takes all, and none can be beyond the bound
  bool leaves_truth = false; // the host finds the ground truth in the records
  bool parts = true;         // pixels that every diode lights are listed apart from the rest
};

// `groups` stand in for all diodes, whose light has that `extent`; `bound` is the one that their sum is held
// against.
Pass uniform_pixels_pass(const PassSetup &on, const SourceGroups &groups, const LightExtent &extent,
                         const ErrorBound &bound, const UniformPixels &pixels,
                         const std::shared_ptr<const PixelLists> &lists);

} // namespace pmdsim
