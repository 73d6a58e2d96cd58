#pragma once
// How a frame is summed within the error asked for: which diodes stand in for all, in which precision, and
// what can be promised of it; and whether that was kept.

#include "engine/light/source_groups.h"
#include "engine/light/sum_model.h"
#include "engine/model/accuracy.h"
#include "engine/model/simulator_options.h"

#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// A frame's light and what it falls on.
struct LightFacts {
  const std::vector<CameraIlluminator> &lights;
  const std::vector<VisibleBox> &visible;
  const Sensor &sensor;
  const Modulation &modulation;
  SumModel model; // of all diodes
  Backscatter backscatter;
  bool long_runs; // of diodes that are alike: on a CPU, whose dispatches need not be short
  PathForms allowed = {};
  bool painted = true; // some surface's backscatter is looked up
};

// What the uniform-pixel pass has to know of the light.
struct LightExtent {
  VisibleBox box;             // holds all diodes, camera frame
  double pattern_slope = 0.0; // radiation_laws.h
};

// Four points of a pixel, whose ranges differ by no more, may stand in for its samples.
inline constexpr double point_spread_m = 0.1;

struct FramePlan {
  Precision precision = Precision::fp32;
  SourceGroups all;            // every diode
  SourceGroups reduced;        // of those, with other intensities, that do where all light and face a point
  SourceGroups uniform_groups; // the reduced set in float, for the uniform-pixel pass
  LightExtent extent;          // of the light, as the reduced set's bound has it
  // Of what the reduced set sums, and of what all do; nothing where no error was asked for.
  std::optional<ErrorBound> bound, bound_of_all;
  // Of all, summed beforehand (point_polynomials.h); likewise, and nothing where they cannot be.
  std::optional<ErrorBound> bound_beforehand;
  // Every diode in fp64, for pixels that may be beyond the bound in float, and what rounding leaves of those;
  // nothing where there are no such pixels, or float is all there is.
  std::optional<SourceGroups> precise;
  std::optional<ErrorBound> bound_of_precise;
  // Of what the uniform-pixel pass sums; nothing where that is not exact enough.
  std::optional<ErrorBound> uniform_bound;
  // Likewise of pixels of several samples that it sums at four points.
  std::optional<ErrorBound> refined_bound;
  bool surely_kept = false; // by every pixel, which is known before the frame
  // Before the frame; nothing where theory knows no bound.
  std::optional<double> claimed_m, claimed_amplitude;

  bool is_reduced() const { return reduced.diodes.size() < all.diodes.size(); }
};

// Of pixels of which some keep the one and some the other.
ErrorBound worse_of(ErrorBound a, const ErrorBound &b);

// Plans for the same frame, each more exact and dearer than the one before.
inline constexpr std::uint32_t frame_plans = 3;

// The `attempt`-th of them. Throws Error (accuracy) where none can bound what is asked for.
FramePlan plan_frame(const LightFacts &view, const Accuracy &accuracy, std::uint32_t attempt);

// Why some pixels of a frame do not keep the error that was asked for; nothing where all pixels' bounds do.
std::optional<std::string> beyond_bound(const shader::BudgetViolations &violations,
                                        const Accuracy &asked_for);
// Why the pixels that were checked do not keep what their bounds promise; nothing where they do. The
// ambiguity range is that of the distances.
std::optional<std::string> beyond_check(const AccuracyReport &found, const Accuracy &asked_for,
                                        double ambiguity_m);

} // namespace pmdsim
