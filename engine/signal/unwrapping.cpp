#include "engine/signal/unwrapping.h"

#include "engine/model/stopwatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tbb/parallel_for.h>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::size_t most_frequencies = 16;
// Beside its noise a phase may be off by this part of a turn: surfaces that a pixel mixes, light that
// bounces.
constexpr double tolerance_turns = 0.005;
// A distance is sure where the phases are no more than three standard deviations off it in the mean of
// squares, and where the next best candidate is so much worse.
constexpr double most_chi2 = 9.0, least_margin = 9.0;

// A frequency's part of a pixel.
struct Remainder {
  double distance_m, ambiguity_m, per_ambiguity; // 1 / ambiguity_m
  double weight;                                 // 1 / variance; 0 where that is not known
};

struct Candidate {
  double distance_m = std::numeric_limits<double>::quiet_NaN(),
         chi2 = std::numeric_limits<double>::infinity();
};

// Of fewer than 2^51 turns; several times as fast as std::nearbyint() without SSE4.1.
double nearest_whole(double turns) {
  constexpr double ones = 0x1.8p52; // whose neighbours are 1 apart
  return (turns + ones) - ones;
}

using Remainders = std::array<Remainder, most_frequencies>;

// The distance around `at_m` that fits all remainders best, and how badly it fits.
Candidate fitted(const Remainders &remainders, std::size_t count, double at_m) {
  double weights = 0.0, mean_m = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto &[distance_m, ambiguity_m, per_ambiguity, weight] = remainders[i];
    const double turns = (distance_m - at_m) * per_ambiguity;
    const double off_m = (turns - nearest_whole(turns)) * ambiguity_m;
    weights += weight;
    mean_m += weight * off_m;
    squares += weight * off_m * off_m;
  }
  mean_m /= weights;
  return {at_m + mean_m, std::max(squares - weights * mean_m * mean_m, 0.0)};
}

struct Unwrapped {
  double distance_m;
  bool ok;
};

// Every distance at which the most precise frequency's phase is what it is.
Unwrapped unwrapped(const Remainders &remainders, std::size_t count, double range_m) {
  const Remainder &finest =
      *std::max_element(remainders.begin(), remainders.begin() + static_cast<std::ptrdiff_t>(count),
                        [](const Remainder &a, const Remainder &b) { return a.weight < b.weight; });
  Candidate best, next;
  for (double at_m = finest.distance_m; at_m < range_m; at_m += finest.ambiguity_m) {
    const Candidate candidate = fitted(remainders, count, at_m);
    if (candidate.chi2 < best.chi2)
      next = std::exchange(best, candidate);
    else if (candidate.chi2 < next.chi2)
      next = candidate;
  }
  const auto freedoms = static_cast<double>(count - 1);
  return {best.distance_m, best.chi2 <= most_chi2 * freedoms && next.chi2 - best.chi2 >= least_margin};
}

} // namespace

void unwrap_distances(const Sensor &sensor, Measurement &frame) {
  const std::size_t pixels = frame.returns.front().distance_m.size(), count = frame.returns.size();
  if (count > most_frequencies)
    throw std::logic_error("more frequencies than can be unwrapped");
  Stopwatch stopwatch;
  frame.unwrapped_distance_m.resize(pixels);
  frame.unwrap_ok.resize(pixels);
  const bool are_unrounded = !frame.returns.front().unrounded_distance_m.empty();
  frame.unrounded_unwrapped_distance_m.resize(are_unrounded ? pixels : 0);
  tbb::parallel_for(std::size_t{0}, pixels, [&](std::size_t pixel) {
    Remainders remainders{};
    bool known = true, sure = true;
    for (std::size_t i = 0; i < count; ++i) {
      const Return &of = frame.returns[i];
      const double ambiguity_m = sensor.ambiguity_m(i), tolerance_m = tolerance_turns * ambiguity_m;
      const double noise_m =
          of.distance_noise_m.empty() ? 0.0 : static_cast<double>(of.distance_noise_m[pixel]);
      const bool is_full = std::isnan(noise_m);
      remainders[i] = {are_unrounded ? of.unrounded_distance_m[pixel]
                                     : static_cast<double>(of.distance_m[pixel]),
                       ambiguity_m, 1.0 / ambiguity_m,
                       is_full ? 0.0 : 1.0 / (noise_m * noise_m + tolerance_m * tolerance_m)};
      known = known && std::isfinite(remainders[i].distance_m);
      sure = sure && !is_full;
    }
    Unwrapped of_pixel{std::numeric_limits<double>::quiet_NaN(), false};
    if (known)
      of_pixel = unwrapped(remainders, count, sensor.unwrap_range_m);
    of_pixel.ok = of_pixel.ok && sure;
    frame.unwrapped_distance_m[pixel] = static_cast<float>(of_pixel.distance_m);
    if (are_unrounded)
      frame.unrounded_unwrapped_distance_m[pixel] = of_pixel.distance_m;
    frame.unwrap_ok[pixel] = of_pixel.ok ? 1 : 0;
  });
  stopwatch.add_to(frame, "unwrap");
}

} // namespace pmdsim
