// The bounds of pixels in the light of narrow beams, for each way from samples to channels.

#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct BeamCase {
  std::string name;
  Waveform waveform{};
  std::uint32_t samples = 1;
  Distortion distortion{};
};

Measurement measured(const BeamCase &of, const Accuracy &accuracy) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {24, 18};
  sensor.modulation_hz = {20e6, 31e6};
  sensor.waveform = of.waveform;
  sensor.samples = of.samples;
  sensor.distortion = of.distortion;
  SimulatorOptions options;
  options.loop = DiodeLoop::looped; // compiles faster
  options.keep_error_bound = true;
  Simulator simulator = make_simulator(options);
  const Scene scene = wall_at(2.0);
  simulator.prepare(scene, sensor, {light_at(ring(40, 0.12), 0.0, {Pattern::Kind::cosine, 400.0})},
                    Backscatter::constant, Shadows::off, accuracy);
  return simulator.measure();
}

} // namespace

TEST_CASE("a pixel's bound grows as the beams that light it dim, and holds") {
  const Waveform harmonics{Waveform::Kind::harmonics, {1.0, 0.0, 0.1}}, square{Waveform::Kind::square, {}};
  for (const BeamCase &of :
       {BeamCase{"sine"}, BeamCase{"harmonics", harmonics}, BeamCase{"square", square},
        BeamCase{"four samples", {}, 2}, BeamCase{"distortion", {}, 1, BrownConrady{.k1 = -0.05}}}) {
    INFO(of.name);
    Accuracy precise, within;
    precise.precision = Precision::fp64;
    within.mode = Mode::automatic;
    within.max_error_m = 1e-3;
    within.precision = Precision::fp32;
    const Measurement exact = measured(of, precise), frame = measured(of, within);
    for (std::size_t f = 0; f < frame.returns.size(); ++f) {
      const Return &is = frame.returns[f], &should = exact.returns[f];
      std::size_t brightest = 0, dimmest = 0;
      for (std::size_t i = 0; i < is.amplitude.size(); ++i) {
        REQUIRE(should.amplitude[i] > 0.0f);
        const double off_m = std::abs(double(is.distance_m[i]) - double(should.distance_m[i]));
        REQUIRE(off_m <= double(is.error_bound_m[i]) + 0x1p-24 * double(should.distance_m[i]));
        brightest = is.amplitude[i] > is.amplitude[brightest] ? i : brightest;
        dimmest = is.amplitude[i] < is.amplitude[dimmest] ? i : dimmest;
      }
      CHECK(is.amplitude[dimmest] < 0.1f * is.amplitude[brightest]);
      CHECK((of.samples > 1 || is.error_bound_m[dimmest] > 1.2f * is.error_bound_m[brightest]));
    }
  }
}
