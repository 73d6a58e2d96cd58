#pragma once
// Random boards: all diodes off at once, by the whole formula. The judge of linear_theory.h, with whose
// slopes it shares nothing but the radiation laws and what taps make of a wave.

#include "engine/tolerance/board_errors.h"
#include "engine/tolerance/lit_view.h"
#include "engine/tolerance/tolerances.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace pmdsim {

// Changes of distance from the board without errors, m, wrapped to a period: a value of each point for each
// board in turn; NaN where no light returns from a point.
struct BoardChanges {
  std::vector<double> weight; // of each point, as LitPoint has it
  std::vector<double> change_m;

  std::size_t points() const { return weight.size(); }
  std::size_t boards() const { return points() > 0 ? change_m.size() / points() : 0; }
  double at(std::size_t board, std::size_t point) const { return change_m[board * points() + point]; }
};

// On TBB's threads; the same bits with any number of them. `between` is called by the calling thread now and
// then with the fraction done; may throw to stop.
BoardChanges board_changes(const LitView &view, const Tolerances &tolerances, const KindsOn &on,
                           std::uint32_t boards, std::uint64_t seed,
                           const std::function<void(double)> &between = {});

// Over boards, of one point.
struct PointStatistics {
  double mean_m, deviation_m;     // NaN where there are fewer than two
  double low_m, median_m, high_m; // quantiles: 2.5 %, 50 %, 97.5 %
};

// Over boards and points; as Deviation in linear_theory.h.
struct BoardStatistics {
  double rms_m, varying_rms_m;
  // Their standard errors, relative to them, by how much boards differ: a few diodes that are seldom dead
  // need many more boards than what is Gaussian.
  double standard_error, varying_standard_error;
  // So much 95 % of the boards do not exceed: the root mean square over the image of a board's change.
  double most_rms_m, most_varying_rms_m;
};

std::vector<PointStatistics> point_statistics(const BoardChanges &changes);
BoardStatistics board_statistics(const BoardChanges &changes);

} // namespace pmdsim
