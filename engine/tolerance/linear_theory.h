#pragma once
// How far distances move by faults of diodes, to first order, with the products of phase errors and others;
// that a diode is dead, exactly. Formulas: docs/diodes.md, "The formulas". A change `at an offset` is what is
// left of it when its mean over the image, which a calibration takes away, is subtracted.

#include "engine/tolerance/lit_view.h"
#include "engine/tolerance/tolerances.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace pmdsim {

// Over the points that any light returns from; NaN where there is none.
struct ImageChange {
  double rms_m = 0.0, max_m = 0.0;                 // max: of the magnitude
  double varying_rms_m = 0.0, varying_max_m = 0.0; // at an offset
};

// The root of the mean square over the image of the standard deviation over boards.
struct Deviation {
  double rms_m = 0.0;
  double varying_rms_m = 0.0; // at an offset
};

struct DiodeEffect {
  double light_share = 0.0;                      // of the light of a point, mean over the points
  std::array<ImageChange, fault_count> faults{}; // of an error as large as its tolerance
  std::size_t left_dark = 0;                     // points that it alone lights: not in what is told of `dead`
  Deviation in_board{};                          // its part in the board's: those of many add up as squares
};

// Kind::position, ..., Kind::dead, and all together.
using BoardDeviation = std::array<Deviation, kind_count + 1>;

// All diodes of one illuminator off alike, by the tolerance.
using AlikeEffect = std::array<ImageChange, slope_count>;

struct LinearTheory {
  std::vector<DiodeEffect> diodes;
  BoardDeviation board{};
  std::vector<AlikeEffect> alike; // by illuminator
  // Of the standard deviation over boards, a value each point, NaN where no light returns.
  std::vector<double> deviation_m, varying_deviation_m;
  std::size_t lit_points = 0;
};

// On TBB's threads; the same bits with any number of them. `between` is called by the calling thread now and
// then with the fraction done; may throw to stop.
LinearTheory linear_theory(const LitView &view, const Tolerances &tolerances,
                           const std::function<void(double)> &between = {});

} // namespace pmdsim
