// Distances from several frequencies together, with errors in each.

#include "engine/signal/unwrapping.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <random>
#include <vector>

using namespace pmdsim;

namespace {

Sensor of_frequencies(const std::vector<double> &frequencies_hz, double range_m) {
  Sensor sensor;
  sensor.modulation_hz = frequencies_hz;
  sensor.unwrap_range_m = range_m;
  return sensor;
}

// Distances that a sensor would measure with noise of so much of a turn.
Measurement wrapped(const Sensor &sensor, const std::vector<double> &distances_m, double noise_turns,
                    std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Measurement frame;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    Return &of = frame.returns.emplace_back();
    const double ambiguity_m = sensor.ambiguity_m(i), noise_m = noise_turns * ambiguity_m;
    for (const double distance_m : distances_m) {
      const double noisy_m = distance_m + noise_m * normal(random);
      of.distance_m.push_back(static_cast<float>(noisy_m - ambiguity_m * std::floor(noisy_m / ambiguity_m)));
      of.distance_noise_m.push_back(static_cast<float>(noise_m));
    }
  }
  return frame;
}

std::vector<double> evenly(double first_m, double last_m, int count) {
  std::vector<double> distances_m;
  for (int i = 0; i < count; ++i)
    distances_m.push_back(first_m + (last_m - first_m) * i / (count - 1));
  return distances_m;
}

} // namespace

TEST_CASE("exact phases unwrap to the distance up to the range") {
  const Sensor sensor = of_frequencies({16e6, 80e6, 120e6}, 18.0);
  const std::vector<double> truth = evenly(0.3, 17.9, 500);
  Measurement frame = wrapped(sensor, truth, 0.0, 1);
  unwrap_distances(sensor, frame);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    CHECK(frame.unwrapped_distance_m[i] == Approx(truth[i]).margin(1e-5));
    CHECK(frame.unwrap_ok[i] == 1);
  }
}

TEST_CASE("where unwrap_ok says 1, noisy phases unwrap to the distance") {
  const Sensor sensor = of_frequencies({16e6, 80e6, 120e6}, 15.0);
  const std::vector<double> truth = evenly(0.5, 14.5, 4000);
  fmt::print("{:<32}{:>10}{:>14}{:>16}{:>14}\n", "unwrapping, noise of each phase", "sure", "wrong of sure",
             "right of others", "noise mm");
  for (const double noise_turns : {0.002, 0.01, 0.02, 0.04, 0.1}) {
    Measurement frame = wrapped(sensor, truth, noise_turns, 7);
    unwrap_distances(sensor, frame);
    double sure = 0, wrong = 0, right_of_others = 0, squares = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double off_m = frame.unwrapped_distance_m[i] - truth[i];
      const bool right = std::abs(off_m) < 0.4;
      if (frame.unwrap_ok[i] == 1) {
        ++sure;
        wrong += right ? 0 : 1;
        squares += right ? off_m * off_m : 0.0;
      } else {
        right_of_others += right ? 1 : 0;
      }
    }
    fmt::print("{:<32}{:>10}{:>14}{:>16}{:>14.2f}\n", fmt::format("{} of a turn", noise_turns), sure, wrong,
               right_of_others, 1e3 * std::sqrt(squares / std::max(sure, 1.0)));
    CHECK(wrong <= 0.002 * static_cast<double>(truth.size()));
    if (noise_turns <= 0.01)
      CHECK(sure > 0.98 * static_cast<double>(truth.size()));
  }
}

TEST_CASE("what lies beyond the range is not known, and a full tap's frequency is left out") {
  const Sensor near = of_frequencies({20e6, 50e6}, 0.5);
  Measurement frame = wrapped(near, {2.0}, 0.0, 1);
  unwrap_distances(near, frame);
  CHECK(std::isnan(frame.unwrapped_distance_m[0]));
  CHECK(frame.unwrap_ok[0] == 0);
  const Sensor sensor = of_frequencies({20e6, 50e6}, 7.0);
  frame = wrapped(sensor, {2.0}, 0.0, 1);
  frame.returns[1].distance_m[0] = 0.4f;
  frame.returns[1].distance_noise_m[0] = std::nanf("");
  unwrap_distances(sensor, frame);
  CHECK(frame.unwrapped_distance_m[0] == Approx(2.0).margin(1e-5));
  CHECK(frame.unwrap_ok[0] == 0);
}

TEST_CASE("phases that do not agree, or are not there, are told") {
  const Sensor sensor = of_frequencies({20e6, 50e6}, 14.0);
  Measurement frame = wrapped(sensor, {2.0, 2.0, 2.0}, 0.0, 1);
  frame.returns[1].distance_m[1] += 1.2f; // a quarter of a turn and more
  frame.returns[0].distance_m[2] = std::nanf("");
  unwrap_distances(sensor, frame);
  CHECK(frame.unwrap_ok[0] == 1);
  CHECK(frame.unwrap_ok[1] == 0);
  CHECK(frame.unwrap_ok[2] == 0);
  CHECK(std::isnan(frame.unwrapped_distance_m[2]));
}
