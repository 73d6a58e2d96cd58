#include "engine/tolerance/linear_theory.h"

#include "engine/tolerance/diode_return.h"
#include "engine/tolerance/few_diodes.h"
#include "engine/tolerance/moments.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

// Behind the faults: the change of a board that has dead ones, and products of two errors of one diode.
constexpr std::size_t dead_on_board = fault_count, first_product = dead_on_board + 1,
                      change_count = first_product + product_count;

// A change's sums over the image.
struct Sums {
  Moments moments{};
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(double value, double weight) {
    moments.add(value, weight);
    if (std::isnan(value))
      return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  ImageChange change() const {
    if (moments.count == 0.0)
      return {no_change, no_change, no_change, no_change};
    return {std::sqrt(moments.mean_square()), std::max(std::abs(least), std::abs(most)),
            std::sqrt(moments.variance()), std::max(most - moments.mean(), moments.mean() - least)};
  }
};

// The changes of one point's distance by each diode, m: of errors as large as the tolerance, and what a diode
// does that is switched off on a board that has dead ones; then products. NaN: no light is left.
struct PointChanges {
  bool is_lit = false;
  std::vector<std::array<double, change_count>> of_diode;
  std::vector<double> light_share;
  // What two dead diodes do beyond what each does alone: the variance over boards, of all pairs.
  double dead_pairs_m2 = 0.0;
};

class Theory {
public:
  Theory(const LitView &view, const Tolerances &tolerances)
      : view_(view), tolerances_(tolerances), demodulation_(view.waveform, view.taps) {
    for (std::size_t i = 0; i < fault_count; ++i)
      size_[i] = tolerances.of(kind_of(static_cast<Fault>(i)));
  }

  PointChanges changes_of(const LitPoint &point) const {
    std::vector<DiodeReturn> returns(view_.diodes.size());
    std::complex<double> z{};
    double light = 0.0;
    for (std::size_t m = 0; m < returns.size(); ++m) {
      if (point.is_reached_by(m))
        returns[m] = diode_return(view_, demodulation_, point, view_.diodes[m]);
      z += returns[m].z;
      light += returns[m].weight;
    }
    PointChanges changes;
    changes.is_lit = std::abs(z) > 0.0;
    if (!changes.is_lit)
      return changes;
    for (const DiodeReturn &of : returns) {
      changes.light_share.push_back(of.weight / light);
      changes.of_diode.push_back(changes_by(of, z));
    }
    changes.dead_pairs_m2 = dead_pairs_m2(returns, z);
    return changes;
  }

  // The variance over boards by a change of the given size, where no other kind of error is.
  double variance(std::size_t fault, double square_m2) const {
    if (fault == dead_on_board)
      return tolerances_.dead * (1.0 - tolerances_.dead) * square_m2;
    const double of_error = tolerances_.error_variance();
    return (fault < first_product ? of_error : of_error * of_error) * square_m2;
  }
  // The same among all errors: of the mean board's light, less what dead diodes miss, one that lives is more.
  double variance_among_all(std::size_t fault, double square_m2) const {
    return variance(fault, square_m2) / (fault == dead_on_board ? 1.0 : 1.0 - tolerances_.dead);
  }

private:
  std::array<double, change_count> changes_by(const DiodeReturn &of, const std::complex<double> &z) const {
    const double metres_per_radian = view_.metres_per_turn() / radians_per_turn;
    std::array<double, change_count> change;
    for (std::size_t i = 0; i < slope_count; ++i)
      change[i] = metres_per_radian * size_[i] * std::imag(of.slope[i] / z);
    // The others as they are, and at the mean of boards.
    const auto switched_off = [&](double others) {
      constexpr double rounding = 1e-12;
      const std::complex<double> off = others * (z - of.z), on = off + of.z;
      return std::abs(off) > rounding * std::abs(of.z) ? metres_per_radian * std::arg(off / on) : no_change;
    };
    change[static_cast<std::size_t>(Fault::dead)] = switched_off(1.0);
    change[dead_on_board] = switched_off(1.0 - tolerances_.dead);
    for (std::size_t i = 0; i < product_count; ++i)
      change[first_product + i] =
          metres_per_radian * size_[i] * tolerances_.phase_rad * product_change(of, i, of, true, z);
    return change;
  }

  // Second differences of the change, all others at the mean of boards. Only diodes that give much of the
  // light make any.
  double dead_pairs_m2(const std::vector<DiodeReturn> &returns, const std::complex<double> &z) const {
    constexpr double least_share = 0.02, rounding = 1e-12;
    std::vector<std::complex<double>> large;
    for (const DiodeReturn &of : returns)
      if (std::abs(of.z) > least_share * std::abs(z))
        large.push_back(of.z);
    const double lives = 1.0 - tolerances_.dead, by_chance = tolerances_.dead * lives;
    double squares = 0.0;
    for (std::size_t m = 0; m < large.size(); ++m)
      for (std::size_t i = 0; i < m; ++i) {
        const std::complex<double> both_off = lives * (z - large[m] - large[i]), m_off = both_off + large[i],
                                   i_off = both_off + large[m], on = m_off + large[m];
        if (std::min({std::abs(both_off), std::abs(m_off), std::abs(i_off)}) <= rounding * std::abs(z))
          continue;
        const double difference = std::arg(both_off / on) - std::arg(m_off / on) - std::arg(i_off / on);
        squares += difference * difference;
      }
    const double metres_per_radian = view_.metres_per_turn() / radians_per_turn;
    return by_chance * by_chance * metres_per_radian * metres_per_radian * squares;
  }

  const LitView &view_;
  const Tolerances &tolerances_;
  Demodulation demodulation_;
  std::array<double, fault_count> size_{};
};

using DiodeSums = std::array<Sums, change_count>;

// What is found of the image, point by point in their order.
class Image {
public:
  explicit Image(const LitView &view)
      : view_(view), diodes_(view.diodes.size()), shares_(diodes_.size()), left_dark_(diodes_.size()) {
    for (const TolerancedDiode &diode : view.diodes)
      illuminators_ = std::max<std::size_t>(illuminators_, diode.illuminator + 1);
    alike_.resize(illuminators_);
  }

  void add(const PointChanges &changes, double weight) {
    if (!changes.is_lit)
      return;
    ++lit_points_;
    lit_weight_ += weight;
    dead_pairs_m2_ += weight * changes.dead_pairs_m2;
    std::vector<std::array<double, slope_count>> alike(illuminators_);
    for (std::size_t m = 0; m < diodes_.size(); ++m) {
      shares_[m] += weight * changes.light_share[m];
      for (std::size_t i = 0; i < change_count; ++i)
        diodes_[m][i].add(changes.of_diode[m][i], weight);
      if (std::isnan(changes.of_diode[m][static_cast<std::size_t>(Fault::dead)]))
        ++left_dark_[m];
      for (std::size_t i = 0; i < slope_count; ++i)
        alike[view_.diodes[m].illuminator][i] += changes.of_diode[m][i];
    }
    for (std::size_t light = 0; light < illuminators_; ++light)
      for (std::size_t i = 0; i < slope_count; ++i)
        alike_[light][i].add(alike[light][i], weight);
  }

  const Sums &of(std::size_t diode, std::size_t fault) const { return diodes_[diode][fault]; }

  LinearTheory theory(const Theory &by) const {
    LinearTheory theory;
    theory.lit_points = lit_points_;
    std::array<double, kind_count + 1> squares{}, varying{};
    for (std::size_t m = 0; m < diodes_.size(); ++m)
      theory.diodes.push_back(effect(m, by, squares, varying));
    for (const std::size_t kind : {static_cast<std::size_t>(Kind::dead), kind_count}) {
      // Pairs differ from point to point: of an offset they make next to nothing.
      squares[kind] += dead_pairs_m2_ / lit_weight_;
      varying[kind] += dead_pairs_m2_ / lit_weight_;
    }
    for (std::size_t kind = 0; kind <= kind_count; ++kind)
      theory.board[kind] = {std::sqrt(squares[kind]), std::sqrt(varying[kind])};
    for (const auto &sums : alike_) {
      AlikeEffect &alike = theory.alike.emplace_back();
      std::ranges::transform(sums, alike.begin(), &Sums::change);
    }
    return theory;
  }

private:
  // Adds to the variances of the board.
  DiodeEffect effect(std::size_t m, const Theory &by, std::array<double, kind_count + 1> &squares,
                     std::array<double, kind_count + 1> &varying) const {
    DiodeEffect effect;
    const DiodeSums &sums = diodes_[m];
    effect.light_share = shares_[m] / lit_weight_;
    for (std::size_t i = 0; i < fault_count; ++i)
      effect.faults[i] = sums[i].change();
    effect.left_dark = left_dark_[m];
    double own_squares = 0.0, own_varying = 0.0;
    for (std::size_t i = 0; i < change_count; ++i) {
      const Moments &of = sums[i].moments;
      if (i == static_cast<std::size_t>(Fault::dead) || of.count == 0.0)
        continue;
      if (i < first_product) { // products are of two kinds
        const auto kind =
            static_cast<std::size_t>(i == dead_on_board ? Kind::dead : kind_of(static_cast<Fault>(i)));
        squares[kind] += by.variance(i, of.mean_square());
        varying[kind] += by.variance(i, of.variance());
      }
      own_squares += by.variance_among_all(i, of.mean_square());
      own_varying += by.variance_among_all(i, of.variance());
    }
    squares[kind_count] += own_squares;
    varying[kind_count] += own_varying;
    effect.in_board = {std::sqrt(own_squares), std::sqrt(own_varying)};
    return effect;
  }

  const LitView &view_;
  std::vector<DiodeSums> diodes_;
  std::vector<double> shares_;
  std::vector<std::size_t> left_dark_;
  std::size_t illuminators_ = 0, lit_points_ = 0;
  double lit_weight_ = 0.0, dead_pairs_m2_ = 0.0;
  std::vector<std::array<Sums, slope_count>> alike_;
};

// The deviation over boards of one point's distance; at the offset of `image` where there is one.
double deviation_m(const PointChanges &changes, const Theory &by, const Image *image) {
  if (!changes.is_lit)
    return no_change;
  double variance = changes.dead_pairs_m2;
  for (std::size_t m = 0; m < changes.of_diode.size(); ++m)
    for (std::size_t i = 0; i < change_count; ++i) {
      if (i == static_cast<std::size_t>(Fault::dead) || std::isnan(changes.of_diode[m][i]))
        continue;
      const double offset_m = image ? image->of(m, i).moments.mean() : 0.0,
                   change = changes.of_diode[m][i] - offset_m;
      variance += by.variance_among_all(i, change * change);
    }
  return std::sqrt(variance);
}

// Calls use(point's number, its changes) in the points' order; a part of them is computed at once.
template <class Use>
void for_each_point(const LitView &view, const Theory &theory, const std::function<void(double)> &between,
                    const Use &use) {
  constexpr std::size_t at_once = 64;
  std::vector<PointChanges> part(at_once);
  for (std::size_t first = 0; first < view.points.size(); first += at_once) {
    const std::size_t count = std::min(at_once, view.points.size() - first);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { part[i] = theory.changes_of(view.points[first + i]); });
    for (std::size_t i = 0; i < count; ++i)
      use(first + i, part[i]);
    between(static_cast<double>(first + count) / static_cast<double>(view.points.size()));
  }
}

} // namespace

LinearTheory linear_theory(const LitView &view, const Tolerances &tolerances,
                           const std::function<void(double)> &between) {
  const Theory by(view, tolerances);
  Image image(view);
  const auto part_from = [&](double done) {
    return [&between, done](double fraction) {
      if (between)
        between(done + 0.5 * fraction);
    };
  };
  for_each_point(view, by, part_from(0.0), [&](std::size_t i, const PointChanges &changes) {
    image.add(changes, view.points[i].weight);
  });
  LinearTheory theory = image.theory(by);
  if (view.diodes.size() <= most_few_diodes && theory.lit_points > 0) {
    FewDiodes few = few_diodes(view, tolerances, part_from(0.5));
    theory.board[static_cast<std::size_t>(Kind::dead)] = few.dead;
    theory.board.back() = few.all;
    theory.deviation_m = std::move(few.deviation_m);
    theory.varying_deviation_m = std::move(few.varying_deviation_m);
    return theory;
  }
  theory.deviation_m.resize(view.points.size());
  theory.varying_deviation_m.resize(view.points.size());
  for_each_point(view, by, part_from(0.5), [&](std::size_t i, const PointChanges &changes) {
    theory.deviation_m[i] = deviation_m(changes, by, nullptr);
    theory.varying_deviation_m[i] = deviation_m(changes, by, &image);
  });
  return theory;
}

} // namespace pmdsim
