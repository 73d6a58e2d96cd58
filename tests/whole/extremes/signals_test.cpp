// As many frequencies and taps as a sensor can have: the sums and the channels of a strip stay below the
// device's limit for a buffer, so that strips become smaller.

#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;

namespace {

// The correlation function of a phase, in turns (docs/theory.md, "The measurement").
double correlation(Waveform::Kind waveform, double turns) {
  if (waveform == Waveform::Kind::sine)
    return std::cos(2 * std::numbers::pi * turns);
  return 4 * std::abs(std::abs(turns - std::round(turns)) - 0.5) - 1;
}

// The largest error of a frequency's taps over the frame, relative to what comes back.
double largest_error(const Measurement &measured, const Sensor &sensor, std::size_t frequency) {
  const auto &taps = measured.returns[frequency].taps;
  double largest = 0.0;
  for (std::size_t i = 0; i < measured.range_m.size(); ++i) {
    const double range_m = measured.range_m[i], turns = range_m / sensor.ambiguity_m(frequency);
    for (std::size_t k = 0; k < taps.size(); ++k) {
      const double tap_turns = turns - double(k) / double(taps.size());
      const double expected = correlation(sensor.waveform.kind, tap_turns); // of 1 W/sr, seen from 1 m
      largest = std::max(largest, std::abs(taps[k][i] * range_m * range_m - expected));
    }
  }
  return largest;
}

} // namespace

TEST_CASE("16 frequencies with 16 taps each") {
  // One source in the lens before a wall, so that each path is twice the range.
  Sensor sensor;
  sensor.taps = 16;
  sensor.modulation_hz.clear();
  for (int f = 1; f <= 16; ++f)
    sensor.modulation_hz.push_back(7e6 * f);
  sensor.waveform.kind = GENERATE(Waveform::Kind::sine, Waveform::Kind::square);
  Simulator simulator = test::make_simulator({.device = {}, .keep_taps = true});
  simulator.prepare(test::wall_at(2.0), sensor, {monostatic_illuminator(sensor.world_from_camera)},
                    Backscatter::constant);
  const Measurement measured = simulator.measure();
  REQUIRE(measured.returns.size() == 16);
  for (std::size_t f = 0; f < 16; ++f) {
    REQUIRE(measured.returns[f].taps.size() == 16);
    CHECK(largest_error(measured, sensor, f) <= 1e-5);
  }
}
