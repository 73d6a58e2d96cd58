// Distances and ranges before they were rounded, of every way to a pixel.

#include "engine/model/channels.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/comparison/random_options.h"
#include "tests/support/random_setups.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <limits>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double half_step = 0x1p-24; // of a float, relative

double off_by(double unrounded, float rounded, double period) {
  const double apart = unrounded - static_cast<double>(rounded);
  return std::abs(std::isfinite(period) ? std::remainder(apart, period) : apart);
}

// Whether what is unrounded lies within half a float's step of what is rounded, in [0, period).
bool is_within_rounding(double unrounded, float rounded, double period) {
  if (std::isnan(unrounded) || std::isnan(rounded))
    return std::isnan(unrounded) && std::isnan(rounded);
  const double half_m = half_step * std::max(unrounded, static_cast<double>(rounded));
  // The largest float below the period may be a whole step off.
  const bool is_last = unrounded > period - 2.0 * half_step * period;
  return off_by(unrounded, rounded, period) <= (is_last ? 2.0 * half_m : half_m) && unrounded >= 0.0 &&
         unrounded < period;
}

void check_rounded(const std::vector<float> &rounded, const std::vector<double> &unrounded, double period) {
  REQUIRE(unrounded.size() == rounded.size());
  std::size_t known = 0, beside = 0;
  for (std::size_t i = 0; i < rounded.size(); ++i) {
    if (!is_within_rounding(unrounded[i], rounded[i], period))
      FAIL(i << ": " << unrounded[i] << " and " << rounded[i]);
    known += std::isnan(rounded[i]) ? 0u : 1u;
    beside += std::isnan(rounded[i]) || unrounded[i] == static_cast<double>(rounded[i]) ? 0u : 1u;
  }
  CHECK(2 * beside >= known); // most values have more digits than a float
}

void check_frame(const Measurement &frame, const Sensor &sensor) {
  for (std::size_t f = 0; f < frame.returns.size(); ++f)
    check_rounded(frame.returns[f].distance_m, frame.returns[f].unrounded_distance_m, sensor.ambiguity_m(f));
  check_rounded(frame.range_m, frame.unrounded_range_m, std::numeric_limits<double>::infinity());
}

void check_other_channels(const std::vector<std::string> &names) {
  for (const std::string &name : names) {
    const RepeatabilityFrame of = repeatability_frame(name);
    INFO(name);
    SimulatorOptions options = keep_everything(9000); // strips
    Simulator without = make_simulator(options);
    options.keep_unrounded = true;
    Simulator with = make_simulator(options);
    const Measurement frame = measure(with, of);
    const bool same = bytes_of(frame) == bytes_of(measure(without, of)); // Catch would print all of them
    CHECK(same);
    check_frame(frame, of.sensor);
  }
}

void check_random_ways(std::initializer_list<std::uint32_t> seeds) {
  for (const std::uint32_t seed : seeds) {
    INFO("seed " << seed);
    const RandomSetup setup = random_setup(seed);
    Random random(seed);
    SimulatorOptions options = random_options(random);
    options.keep_unrounded = true;
    options.keep_error_bound = random.flip();
    Accuracy accuracy;
    if (random.flip()) {
      accuracy.mode = Mode::automatic;
      accuracy.max_error_m = 1e-3;
    }
    Simulator simulator = make_simulator(options);
    const auto measure_once = [&] {
      simulator.prepare(setup.scene, setup.sensor, setup.illuminators, setup.backscatter, setup.shadows,
                        accuracy);
      return simulator.measure();
    };
    Measurement frame = measure_once();
    check_frame(frame, setup.sensor);
    simulator.reuse(std::move(frame));
    options.keep_unrounded = false;
    simulator.change(options);
    const Measurement without = measure_once();
    CHECK(without.returns[0].unrounded_distance_m.empty());
    CHECK(without.unrounded_range_m.empty());
  }
}

} // namespace

TEST_CASE("unrounded distances lie within a rounding, and all other channels keep their bits") {
  check_other_channels(every_third(repeatability_frames()));
}

TEST_CASE("unrounded distances of all frames lie within a rounding", "[long]") {
  check_other_channels(repeatability_frames());
}

TEST_CASE(
    "unrounded distances are there whatever way a frame takes, and are gone where nobody asks for them") {
  check_random_ways({41u});
}

TEST_CASE("unrounded distances are there whatever way a frame takes, other ways", "[long]") {
  check_random_ways({3u, 20u, 62u, 77u});
}
