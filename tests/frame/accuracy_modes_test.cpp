// The modes and precisions of engine/model/accuracy.h, and how they are related.

#include "engine/model/error.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Accuracy within(Mode mode, double max_error_m) {
  Accuracy accuracy;
  accuracy.mode = mode;
  accuracy.max_error_m = max_error_m;
  return accuracy;
}

Accuracy in(Precision precision) {
  Accuracy accuracy;
  accuracy.precision = precision;
  return accuracy;
}

// A ring before a wall at 2 m.
Measurement measure(int diodes, const Accuracy &accuracy, double modulation_hz = 20e6, double phase_rad = 0.0,
                    Backscatter backscatter = Backscatter::lambert) {
  const Scene scene = wall_at(2.0);
  Sensor sensor = wide_sensor();
  sensor.modulation_hz = {modulation_hz};
  Simulator simulator = make_simulator();
  simulator.prepare(scene, sensor, {light_at(ring(diodes, 0.166), phase_rad)}, backscatter, Shadows::off,
                    accuracy);
  return simulator.measure();
}

double largest_difference_m(const Measurement &one, const Measurement &other) {
  double largest_m = 0.0;
  for (std::size_t i = 0; i < one.range_m.size(); ++i)
    largest_m =
        std::max(largest_m, std::abs(double(one.returns[0].distance_m[i]) - other.returns[0].distance_m[i]));
  return largest_m;
}

ExitCode refusal_of(const Accuracy &accuracy, double modulation_hz, double phase_rad) {
  try {
    measure(240, accuracy, modulation_hz, phase_rad);
  } catch (const Error &error) {
    return error.code();
  }
  return ExitCode::done;
}

} // namespace

TEST_CASE("a single diode has nothing to be reduced to") {
  // To a unit of a float at 2 m, as the two are summed by loops of their own.
  const Measurement exact = measure(1, {}), reduced = measure(1, within(Mode::reduced, 1.0));
  CHECK(reduced.accuracy.diodes == 1);
  CHECK(largest_difference_m(exact, reduced) <= 0x1p-22);
}

TEST_CASE("few diodes stand in for many where much error is borne") {
  const Measurement exact = measure(240, {}), coarse = measure(240, within(Mode::reduced, 1e-2)),
                    fine = measure(240, within(Mode::reduced, 1e-5));
  CHECK(coarse.accuracy.diodes < fine.accuracy.diodes);
  CHECK(fine.accuracy.diodes < 240);
  CHECK(largest_difference_m(exact, coarse) <= 1e-2);
  CHECK(largest_difference_m(exact, fine) <= 1e-5);
}

TEST_CASE("the precisions are no further apart than their claims") {
  // Without Lambert's cosine, of which only each pixel knows how far it is from grazing light.
  const auto measured = [](Precision precision) {
    return measure(240, in(precision), 20e6, 0.0, Backscatter::constant);
  };
  const Measurement fp32 = measured(Precision::fp32), fp64 = measured(Precision::fp64);
  CHECK(fp32.accuracy.precision == Precision::fp32);
  CHECK(fp64.accuracy.precision == Precision::fp64);
  REQUIRE((fp32.accuracy.claimed_m && fp64.accuracy.claimed_m));
  CHECK(*fp64.accuracy.claimed_m < *fp32.accuracy.claimed_m);
  CHECK(largest_difference_m(fp32, fp64) <= *fp32.accuracy.claimed_m + *fp64.accuracy.claimed_m);
}

TEST_CASE("what a float cannot hold is not promised") {
  // Half a turn of 1 kHz is 75 km, of which a float's last bit is 8 mm.
  const double half_turn_rad = 0.5 * full_turn_rad;
  for (const Mode mode : {Mode::reduced, Mode::automatic}) {
    CHECK(refusal_of(within(mode, 1e-3), 1e3, half_turn_rad) == ExitCode::accuracy);
    CHECK(refusal_of(within(mode, 1e-9), 20e6, 0.0) == ExitCode::accuracy);
  }
  CHECK(refusal_of(within(Mode::automatic, 0.1), 1e3, half_turn_rad) == ExitCode::done);
}
