#include "engine/tolerance/few_diodes.h"

#include "engine/tolerance/diode_return.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace pmdsim {
namespace {

// What a set of dead diodes does to one point, m: its change of distance, NaN where it is dark, and the
// changes by an error of each diode that lives, as large as the tolerance.
struct SetChanges {
  double of_set = no_change;
  std::vector<double> of_errors; // slope_count for each diode; 0 for dead ones
};

class Points {
public:
  Points(const LitView &view, const Tolerances &tolerances)
      : metres_per_radian_(view.metres_per_turn() / radians_per_turn), tolerances_(tolerances) {
    const Demodulation demodulation(view.waveform, view.taps);
    for (const LitPoint &point : view.points) {
      std::vector<DiodeReturn> &returns = points_.emplace_back(view.diodes.size());
      for (std::size_t m = 0; m < returns.size(); ++m)
        if (point.is_reached_by(m))
          returns[m] = diode_return(view, demodulation, point, view.diodes[m]);
    }
  }

  SetChanges changes(std::size_t point, std::uint32_t dead) const {
    constexpr double rounding = 1e-12;
    const std::vector<DiodeReturn> &returns = points_[point];
    std::complex<double> all{}, left{};
    double size = 0.0;
    for (std::size_t m = 0; m < returns.size(); ++m) {
      all += returns[m].z;
      left += is_dead(dead, m) ? 0.0 : returns[m].z;
      size += std::abs(returns[m].z);
    }
    SetChanges changes;
    if (std::abs(all) == 0.0 || std::abs(left) <= rounding * size)
      return changes;
    changes.of_set = dead == 0 ? 0.0 : metres_per_radian_ * std::arg(left / all);
    for (std::size_t m = 0; m < returns.size(); ++m)
      for (std::size_t i = 0; i < slope_count; ++i)
        changes.of_errors.push_back(is_dead(dead, m) ? 0.0
                                                     : metres_per_radian_ *
                                                           tolerances_.of(kind_of(static_cast<Fault>(i))) *
                                                           std::imag(returns[m].slope[i] / left));
    return changes;
  }

  // The changes by two errors of two diodes at once: one of the phase and one of those before it.
  std::vector<double> products(std::size_t point) const {
    const std::vector<DiodeReturn> &returns = points_[point];
    std::complex<double> all{};
    for (const DiodeReturn &of : returns)
      all += of.z;
    std::vector<double> changes;
    for (const DiodeReturn &of : returns)
      for (std::size_t i = 0; i < product_count; ++i)
        for (const DiodeReturn &late : returns)
          changes.push_back(metres_per_radian_ * tolerances_.of(kind_of(static_cast<Fault>(i))) *
                            tolerances_.phase_rad * product_change(of, i, late, &of == &late, all));
    return changes;
  }

private:
  static bool is_dead(std::uint32_t dead, std::size_t diode) { return (dead >> diode & 1U) != 0; }

  double metres_per_radian_;
  const Tolerances &tolerances_;
  std::vector<std::vector<DiodeReturn>> points_;
};

// Over the points that are not dark.
SetChanges mean_of(const LitView &view, const std::vector<SetChanges> &changes, std::size_t errors) {
  SetChanges mean{0.0, std::vector<double>(errors, 0.0)};
  double count = 0.0;
  for (std::size_t point = 0; point < changes.size(); ++point) {
    const SetChanges &of = changes[point];
    if (std::isnan(of.of_set))
      continue;
    const double weight = view.points[point].weight;
    count += weight;
    mean.of_set += weight * of.of_set;
    for (std::size_t i = 0; i < errors; ++i)
      mean.of_errors[i] += weight * of.of_errors[i];
  }
  mean.of_set /= count;
  for (double &error : mean.of_errors)
    error /= count;
  return mean;
}

// Of one point over the sets: sums of their chances, of the sets' changes, and of the errors' variances.
struct SetSums {
  double chance = 0.0, sum = 0.0, squares = 0.0, errors = 0.0;
  double products = 0.0; // of errors, whichever diodes are dead

  void add(double of_chance, const SetChanges &of, const SetChanges *offset, double variance) {
    const double change = of.of_set - (offset ? offset->of_set : 0.0);
    chance += of_chance;
    sum += of_chance * change;
    squares += of_chance * change * change;
    for (std::size_t i = 0; i < of.of_errors.size(); ++i) {
      const double error = of.of_errors[i] - (offset ? offset->of_errors[i] : 0.0);
      errors += of_chance * variance * error * error;
    }
  }
  double dead() const {
    const double mean = sum / chance;
    return std::max(0.0, squares / chance - mean * mean);
  }
  double all() const { return dead() + errors / chance + products; }
};

void add_products(const LitView &view, const Points &points, double variance, std::vector<SetSums> &sums,
                  std::vector<SetSums> &varying) {
  std::vector<std::vector<double>> changes(sums.size());
  std::vector<double> mean;
  double lit = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].chance == 0.0)
      continue;
    changes[i] = points.products(i);
    mean.resize(changes[i].size());
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += view.points[i].weight * changes[i][k];
    lit += view.points[i].weight;
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t k = 0; k < changes[i].size(); ++k) {
      const double change = changes[i][k], vary = change - mean[k] / lit;
      sums[i].products += variance * variance * change * change;
      varying[i].products += variance * variance * vary * vary;
    }
}

double chance_of(std::uint32_t dead, std::size_t diodes, double chance) {
  double product = 1.0;
  for (std::size_t m = 0; m < diodes; ++m)
    product *= (dead >> m & 1U) != 0 ? chance : 1.0 - chance;
  return product;
}

} // namespace

FewDiodes few_diodes(const LitView &view, const Tolerances &tolerances,
                     const std::function<void(double)> &between) {
  const Points points(view, tolerances);
  const std::size_t diodes = view.diodes.size();
  const std::uint32_t sets = 1U << diodes;
  std::vector<SetSums> sums(view.points.size()), varying(sums);
  for (std::uint32_t dead = 0; dead < sets; ++dead) {
    const double chance = chance_of(dead, diodes, tolerances.dead);
    std::vector<SetChanges> changes;
    for (std::size_t i = 0; i < sums.size(); ++i)
      changes.push_back(points.changes(i, dead));
    const SetChanges mean = mean_of(view, changes, diodes * slope_count);
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (!std::isnan(changes[i].of_set)) {
        sums[i].add(chance, changes[i], nullptr, tolerances.error_variance());
        varying[i].add(chance, changes[i], &mean, tolerances.error_variance());
      }
    if (between)
      between((dead + 1.0) / sets);
  }
  add_products(view, points, tolerances.error_variance(), sums, varying);
  FewDiodes result{};
  std::array<double, 4> squares{};
  double lit = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const bool is_lit = sums[i].chance > 0.0;
    result.deviation_m.push_back(is_lit ? std::sqrt(sums[i].all()) : no_change);
    result.varying_deviation_m.push_back(is_lit ? std::sqrt(varying[i].all()) : no_change);
    if (!is_lit)
      continue;
    const double weight = view.points[i].weight;
    lit += weight;
    const std::array of{sums[i].dead(), varying[i].dead(), sums[i].all(), varying[i].all()};
    for (std::size_t k = 0; k < of.size(); ++k)
      squares[k] += weight * of[k];
  }
  const auto rms = [&](std::size_t k) { return std::sqrt(squares[k] / lit); };
  result.dead = {rms(0), rms(1)};
  result.all = {rms(2), rms(3)};
  return result;
}

} // namespace pmdsim
