#pragma once
// An extreme setup on the device against the reference, pixel by pixel.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "tests/whole/extremes/extreme_setups.h"

#include <string>
#include <vector>

namespace pmdsim::test {

// The reference's frame, and the largest error that is allowed at each pixel: 1 micrometre or 1.2e-7 of the
// distance (of the point or of the wrapped distance, whichever is larger: the last bits of its float), and a
// thousandth of the ambiguity range at most; times the pixel's condition, as far as returns cancel.
class ExtremeTruth {
public:
  explicit ExtremeTruth(const ExtremeSetup &setup);

  const BuiltSetup &setup() const { return built_; }
  const reference::Frame &frame() const { return frame_; }
  double ambiguity_m() const { return frame_.returns[0].ambiguity_m; }

  double limit_m(std::size_t pixel) const;
  double condition(std::size_t pixel) const { return frame_.returns[0].condition[pixel]; }
  // Light returns, and does not cancel so far that rounding shows in the reference's double.
  bool is_known(std::size_t pixel) const;

  // Over all pixels that are known.
  double smallest_limit_m() const;
  double largest_condition() const;

private:
  BuiltSetup built_;
  reference::Frame frame_;
};

struct ExtremeRun {
  std::string refusal;         // why there is no frame; empty where there is one
  bool refused_rightly = true; // as input or accuracy
  AccuracyReport accuracy;
  std::size_t pixels = 0;        // compared: known, and their samples see the same triangles
  std::size_t differing = 0;     // their samples see other triangles
  std::size_t impossible = 0;    // not a number, infinite, negative or beyond its range where it may not be
  double error_m = 0.0;          // the largest of distance, wrapped
  double error_over_limit = 0.0; // the largest of error / limit
  double amplitude_error = 0.0;  // the largest, relative
};

ExtremeRun run(Simulator &simulator, const ExtremeTruth &truth, const Accuracy &accuracy);

} // namespace pmdsim::test
