#include "engine/tolerance/monte_carlo.h"

#include "engine/tolerance/board_work.h"
#include "engine/tolerance/demodulation.h"
#include "engine/tolerance/moments.h"
#include "engine/tolerance/radiation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr std::size_t padding = 8; // lanes of the widest vectors

std::size_t padded(std::size_t count) { return (count + padding - 1) / padding * padding; }

// J as the loops have it: of all diodes alike, isotropic or a whole power; else it is found diode by diode.
struct CommonLaw {
  bool is_isotropic;
  std::uint32_t order;
};

std::optional<CommonLaw> common_law(const std::vector<TolerancedDiode> &diodes) {
  constexpr double most = 1000.0;
  const Pattern &first = diodes.front().diode.pattern;
  for (const TolerancedDiode &diode : diodes)
    if (diode.diode.pattern.kind != first.kind || diode.diode.pattern.order != first.order)
      return std::nullopt;
  if (first.kind == Pattern::Kind::isotropic)
    return CommonLaw{true, 0};
  if (first.kind != Pattern::Kind::cosine || first.order != std::floor(first.order) || first.order > most)
    return std::nullopt;
  return CommonLaw{false, static_cast<std::uint32_t>(first.order)};
}

// A board's diodes as arrays.
class Board {
public:
  explicit Board(std::size_t diodes) : count_(padded(diodes)), values_(arrays * count_) {}

  void set(std::size_t m, const TolerancedDiode &of) {
    const Diode &d = of.diode;
    const std::array<double, arrays> values{d.position_m.x, d.position_m.y, d.position_m.z,   d.axis.x,
                                            d.axis.y,       d.axis.z,       d.intensity_w_sr, of.phase_turns};
    for (std::size_t i = 0; i < arrays; ++i)
      values_[i * count_ + m] = values[i];
  }
  // Behind the last diode: where that is, and dark.
  void pad(TolerancedDiode last, std::size_t diodes) {
    last.diode.intensity_w_sr = 0.0;
    for (std::size_t m = diodes; m < count_; ++m)
      set(m, last);
  }
  BoardWork work() const {
    const auto array = [&](std::size_t i) { return values_.data() + i * count_; };
    return {count_,   array(0), array(1), array(2), array(3), array(4), array(5),
            array(6), array(7), true,     0,        nullptr,  0.0};
  }

private:
  static constexpr std::size_t arrays = 8;
  std::size_t count_;
  std::vector<double> values_;
};

class Boards {
public:
  explicit Boards(const LitView &view)
      : view_(view), demodulation_(view.waveform, view.taps), law_(common_law(view.diodes)),
        loops_(widest_board_loops(512)) {
    const std::size_t count = padded(view.diodes.size());
    reach_.resize(view.points.size() * count);
    for (std::size_t i = 0; i < view.points.size(); ++i)
      for (std::size_t m = 0; m < view.diodes.size(); ++m)
        reach_[i * count + m] = view.points[i].is_reached_by(m) ? 1.0 : 0.0;
  }

  // z of each point.
  std::vector<std::complex<double>> returns(const std::vector<TolerancedDiode> &diodes) const {
    Board board(diodes.size());
    for (std::size_t m = 0; m < diodes.size(); ++m)
      board.set(m, diodes[m]);
    board.pad(diodes.back(), diodes.size());
    BoardWork work = board.work();
    work.turns_per_m = view_.turns_per_m();
    if (law_) {
      work.is_isotropic = law_->is_isotropic;
      work.order = law_->order;
    }
    std::vector<std::complex<double>> z;
    std::vector<double> relative(law_ ? 0 : work.count),
        scratch(demodulation_.is_sine() ? 0 : 2 * work.count);
    for (std::size_t i = 0; i < view_.points.size(); ++i) {
      if (!law_) {
        for (std::size_t m = 0; m < diodes.size(); ++m)
          relative[m] = towards(diodes[m].diode, view_.points[i]);
        work.relative = relative.data();
      }
      z.push_back(sum(work, point_work(i, work.count), scratch));
    }
    return z;
  }

private:
  static double towards(const Diode &diode, const LitPoint &point) {
    return radiation(diode, glm::normalize(point.position_m - diode.position_m)).value;
  }

  PointWork point_work(std::size_t i, std::size_t count) const {
    const LitPoint &point = view_.points[i];
    const bool is_lambert = view_.backscatter == Backscatter::lambert;
    return {point.position_m.x,
            point.position_m.y,
            point.position_m.z,
            point.normal.x,
            point.normal.y,
            point.normal.z,
            is_lambert ? point.gain * std::numbers::inv_pi : point.gain,
            is_lambert,
            glm::length(point.position_m),
            reach_.data() + i * count};
  }

  std::complex<double> sum(const BoardWork &board, const PointWork &point,
                           std::vector<double> &scratch) const {
    if (demodulation_.is_sine()) {
      double re = 0.0, im = 0.0;
      loops_.sum(board, point, re, im);
      return {re, im};
    }
    double *weights = scratch.data(), *turns = weights + board.count;
    loops_.terms(board, point, weights, turns);
    std::complex<double> z{};
    for (std::size_t m = 0; m < board.count; ++m)
      if (weights[m] > 0.0)
        z += weights[m] * demodulation_.at(turns[m]).of_unit;
    return z;
  }

  const LitView &view_;
  Demodulation demodulation_;
  std::optional<CommonLaw> law_;
  const BoardLoops &loops_;
  std::vector<double> reach_; // of each point, padded
};

// Of values that are numbers; sorts them.
double quantile(std::vector<double> &values, double share) {
  if (values.empty())
    return no_change;
  std::ranges::sort(values);
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

// Each board's changes less their mean over its points.
BoardChanges varying(BoardChanges changes) {
  for (std::size_t board = 0; board < changes.boards(); ++board) {
    Moments of;
    double *const change_m = changes.change_m.data() + board * changes.points();
    for (std::size_t i = 0; i < changes.points(); ++i)
      of.add(change_m[i], changes.weight[i]);
    for (std::size_t i = 0; i < changes.points(); ++i)
      change_m[i] -= of.mean();
  }
  return changes;
}

struct Found {
  double deviation_m, standard_error;
};

// The root of the mean over points of the variance over boards. A board's part in that variance is the mean
// square of how far its points are off their means.
Found found(const BoardChanges &changes) {
  Moments of_points;
  std::vector<double> means_m;
  for (std::size_t i = 0; i < changes.points(); ++i) {
    Moments of;
    for (std::size_t board = 0; board < changes.boards(); ++board)
      of.add(changes.at(board, i));
    of_points.add(of.sample_variance(), changes.weight[i]);
    means_m.push_back(of.mean());
  }
  Moments of_boards;
  for (std::size_t board = 0; board < changes.boards(); ++board) {
    Moments of;
    for (std::size_t i = 0; i < changes.points(); ++i)
      of.add(changes.at(board, i) - means_m[i], changes.weight[i]);
    of_boards.add(of.mean_square());
  }
  const double variance = of_points.mean();
  return {std::sqrt(variance), 0.5 * std::sqrt(of_boards.sample_variance() / of_boards.count) / variance};
}

double most_rms_m(const BoardChanges &changes) {
  constexpr double share = 0.95;
  std::vector<double> rms_m;
  for (std::size_t board = 0; board < changes.boards(); ++board) {
    Moments of;
    for (std::size_t i = 0; i < changes.points(); ++i)
      of.add(changes.at(board, i), changes.weight[i]);
    if (of.count > 0.0)
      rms_m.push_back(std::sqrt(of.mean_square()));
  }
  return quantile(rms_m, share);
}

} // namespace

BoardChanges board_changes(const LitView &view, const Tolerances &tolerances, const KindsOn &on,
                           std::uint32_t boards, std::uint64_t seed,
                           const std::function<void(double)> &between) {
  constexpr std::uint32_t at_once = 64;
  const Boards of(view);
  const std::vector<std::complex<double>> nominal = of.returns(view.diodes);
  const double metres_per_radian = view.metres_per_turn() / radians_per_turn;
  BoardChanges changes{{}, std::vector<double>(boards * view.points.size())};
  for (const LitPoint &point : view.points)
    changes.weight.push_back(point.weight);
  const auto change = [&](std::uint32_t board) {
    std::vector<TolerancedDiode> diodes;
    diodes.reserve(view.diodes.size());
    for (std::uint32_t m = 0; m < view.diodes.size(); ++m)
      diodes.push_back(on_board(view.diodes[m], tolerances, on, seed, board, m));
    const std::vector<std::complex<double>> z = of.returns(diodes);
    for (std::size_t i = 0; i < z.size(); ++i)
      changes.change_m[board * z.size() + i] =
          z[i] == 0.0 || nominal[i] == 0.0 ? no_change
                                           : metres_per_radian * std::arg(z[i] * std::conj(nominal[i]));
  };
  for (std::uint32_t first = 0; first < boards; first += at_once) {
    const std::uint32_t end = std::min(boards, first + at_once);
    tbb::parallel_for(first, end, change);
    if (between)
      between(static_cast<double>(end) / boards);
  }
  return changes;
}

std::vector<PointStatistics> point_statistics(const BoardChanges &changes) {
  std::vector<PointStatistics> statistics;
  for (std::size_t i = 0; i < changes.points(); ++i) {
    Moments of;
    std::vector<double> known_m;
    for (std::size_t board = 0; board < changes.boards(); ++board) {
      const double change_m = changes.at(board, i);
      of.add(change_m);
      if (!std::isnan(change_m))
        known_m.push_back(change_m);
    }
    statistics.push_back({of.mean(), std::sqrt(of.sample_variance()), quantile(known_m, 0.025),
                          quantile(known_m, 0.5), quantile(known_m, 0.975)});
  }
  return statistics;
}

BoardStatistics board_statistics(const BoardChanges &changes) {
  const BoardChanges at_offset = varying(changes);
  const Found all = found(changes), vary = found(at_offset);
  return {all.deviation_m,     vary.deviation_m,    all.standard_error,
          vary.standard_error, most_rms_m(changes), most_rms_m(at_offset)};
}

} // namespace pmdsim
