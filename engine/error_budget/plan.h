#pragma once
// How a frame is summed within the error asked for: which diodes stand in for all, in which precision, and
// what can be promised of it; and whether that was kept.

#include "engine/light/source_groups.h"
#include "engine/light/source_windows.h"
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
  bool on_host; // the device is the host's processor: its dispatches need not be short, and the host may sum
  PathForms allowed = {};
  bool painted = true;                                       // some surface's backscatter is looked up
  std::uint32_t window_bundles = shader::bundles_per_window; // of visibility bits that are there together
};

// The light's extent, for the uniform-pixel pass.
struct LightExtent {
  VisibleBox box;             // holds all diodes, camera frame
  double pattern_slope = 0.0; // radiation_laws.h
};

// Four points of a pixel may stand in for its samples where their ranges differ by no more.
inline constexpr double point_spread_m = 0.1;

struct FramePlan {
  Precision precision = Precision::fp32;
  SourceGroups all;            // every diode
  SourceGroups reduced;        // some of those, with other intensities, for points that all light and face
  SourceGroups uniform_groups; // the reduced set in float, for the uniform-pixel pass
  LightExtent extent;          // of the light, as the reduced set's bound has it
  // The bounds of the reduced set's sum and of the sum of all; nothing where no error was asked for.
  std::optional<ErrorBound> bound, bound_of_all;
  // The bound of all, summed beforehand (point_polynomials.h); nothing also where they cannot be.
  std::optional<ErrorBound> bound_beforehand;
  // Every diode in fp64, for pixels that may be beyond the bound in float, and the bound of those; nothing
  // where there are no such pixels, or float is all there is.
  std::optional<SourceGroups> precise;
  std::optional<ErrorBound> bound_of_precise;
  // The bound of the uniform-pixel pass's sum; nothing where that is not exact enough.
  std::optional<ErrorBound> uniform_bound;
  // Likewise for pixels of several samples that it sums at four points.
  std::optional<ErrorBound> refined_bound;
  // In which the sums over all are interpolated where they are loops (planned_field.h); nothing where each
  // sample has sums of its own. Pixels that it does not do for have those, too.
  std::optional<InterpolatedField> field;
  bool surely_kept = false; // every pixel's error is within the limits, as is known before the frame
  // The errors claimed before the frame; nothing where theory knows no bound.
  std::optional<double> claimed_m, claimed_amplitude;

  bool has_beams() const; // some bound has narrow beams' errors (ErrorBound::beams)
  bool is_reduced() const { return reduced.diodes.size() < all.diodes.size(); }
};

// Plans for the same frame, each more exact and dearer than the one before.
inline constexpr std::uint32_t frame_plans = 3;

// Makes the `attempt`-th of them. Throws Error (accuracy) where none can bound what is asked for.
FramePlan plan_frame(const LightFacts &view, const Accuracy &accuracy, std::uint32_t attempt);

// Why some pixels of a frame do not keep the error that was asked for; nothing where all pixels' bounds do.
std::optional<std::string> beyond_bound(const shader::BudgetViolations &violations,
                                        const Accuracy &asked_for);
// Why the pixels that were checked do not keep what their bounds promise; nothing where they do. The
// ambiguity range is that of the distances.
std::optional<std::string> beyond_check(const AccuracyReport &found, const Accuracy &asked_for,
                                        double ambiguity_m);

} // namespace pmdsim
