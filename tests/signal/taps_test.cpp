// Frequencies, correlation samples and what a camera makes of them, of paths with a known phase.

#include "tests/comparison/engines.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const SimulatorOptions with_taps{.device = {}, .keep_taps = true};

// The readings of one pixel, in units of its light.
struct Reading {
  std::vector<double> taps;
  double amplitude, phase_turns;
};

void check_reading(Engine engine, const std::string &name, const Reading &expected, const Sensor &sensor,
                   const Measurement &measured, double light_w_m2_sr, std::size_t pixel = 0) {
  const Return &got = measured.returns[0];
  REQUIRE(got.taps.size() == expected.taps.size());
  for (std::size_t k = 0; k < expected.taps.size(); ++k)
    check_within(engine, fmt::format("{}, tap {}", name, k), expected.taps[k],
                 got.taps[k][pixel] / light_w_m2_sr, 2e-6);
  check_amplitude(engine, name + ", amplitude", expected.amplitude, got.amplitude[pixel] / light_w_m2_sr);
  check_distance(engine, name + ", distance", expected.phase_turns * sensor.ambiguity_m(), sensor,
                 got.distance_m[pixel]);
  check_within(engine, name + ", phase, turns", expected.phase_turns, got.phase_rad[pixel] / full_turn_rad,
               2e-7);
}

// Where a wall returns light of the phase, a turn and more away.
double wall_m(double phase_turns, const Sensor &sensor) { return (1 + phase_turns) * sensor.ambiguity_m(); }

void check_single_path(const std::string &name, const Sensor &sensor, double phase_turns,
                       const Reading &expected) {
  const Engine engine = both_engines();
  const double z_m = wall_m(phase_turns, sensor), reflectivity = 0.4;
  SceneBuilder builder;
  builder.add_wall({z_m, {reflectivity}});
  const Measurement measured =
      measure_monostatic(engine, builder.scene(), sensor, Backscatter::constant, with_taps);
  check_reading(engine, name, expected, sensor, measured, reflectivity / (z_m * z_m));
}

Sensor sensor_of(Waveform::Kind kind, std::uint32_t taps, const std::vector<double> &harmonics = {}) {
  Sensor sensor = axial_sensor();
  sensor.waveform = {kind, harmonics};
  sensor.taps = taps;
  return sensor;
}

double turns_of(double y, double x) {
  const double turns = std::atan2(y, x) / full_turn_rad;
  return turns < 0 ? turns + 1 : turns;
}

} // namespace

TEST_CASE("each frequency has its distance, wrapped to its own ambiguity") {
  const Engine engine = both_engines();
  Sensor sensor = axial_sensor();
  sensor.modulation_hz = {20e6, 60e6, 100e6};
  const double z_m = 9.3;
  // 9.3 m less 1, 3 and 6 times c / (2 f) = 7.49481145, 2.49827048 and 1.49896229 m.
  const std::vector<double> wrapped_m{1.80518855, 1.80518855, 0.30622626};
  for (const auto kind : {Waveform::Kind::sine, Waveform::Kind::harmonics}) {
    sensor.waveform = {kind, {1.0}};
    const Measurement measured =
        measure_monostatic(engine, wall_at(z_m), sensor, Backscatter::constant, with_taps);
    REQUIRE(measured.returns.size() == 3);
    for (std::size_t f = 0; f < 3; ++f) {
      const std::string name = fmt::format("{:g} MHz{}", sensor.modulation_hz[f] / 1e6,
                                           kind == Waveform::Kind::sine ? "" : ", one harmonic");
      check_distance(engine, name, z_m, sensor, measured.returns[f].distance_m[0], f);
      check_within(engine, name + ", by hand", wrapped_m[f], measured.returns[f].distance_m[0], 2e-6);
      check_amplitude(engine, name + ", amplitude", 1 / (z_m * z_m), measured.returns[f].amplitude[0]);
      CHECK(measured.returns[f].taps.size() == sensor.taps);
    }
  }
}

TEST_CASE("square light has a distance at each frequency, too") {
  const Engine engine = both_engines();
  Sensor sensor = sensor_of(Waveform::Kind::square, 4);
  sensor.modulation_hz = {20e6, 40e6, 60e6};
  // 1/8, 2/8 and 3/8 of a turn, where four taps see the phase as it is.
  const double z_m = wall_m(0.125, sensor);
  const std::vector<double> amplitudes{std::sqrt(0.5), 1, std::sqrt(0.5)};
  const Measurement measured =
      measure_monostatic(engine, wall_at(z_m), sensor, Backscatter::constant, with_taps);
  for (std::size_t f = 0; f < 3; ++f) {
    const std::string name = fmt::format("square, {:g} MHz", sensor.modulation_hz[f] / 1e6);
    check_distance(engine, name, z_m, sensor, measured.returns[f].distance_m[0], f);
    check_amplitude(engine, name + ", amplitude", amplitudes[f],
                    z_m * z_m * measured.returns[f].amplitude[0]);
  }
}

TEST_CASE("frequencies mix two returns each by its own phase") {
  const Engine engine = both_engines();
  Sensor sensor = axial_sensor();
  sensor.modulation_hz = {20e6, 30e6, 75e6};
  // Two diodes whose paths differ by c / 60 MHz: half a turn at 30 MHz, where they cancel, a third at 20 MHz,
  // 1 1/4 at 75 MHz.
  const double z_m = 2, behind_m = speed_of_light_m_s / 60e6, far_m = z_m + behind_m;
  Illuminator light = diode_beside_lens(sensor, diode_at({0, 0, 0}));
  light.diodes.push_back(diode_at({0, 0, -behind_m}));
  light.diodes[1].intensity_w_sr = far_m * far_m / (z_m * z_m);
  const Measurement measured = measure(engine, wall_at(z_m), sensor, light, Backscatter::constant);
  check_amplitude(engine, "two paths at 20 MHz, amplitude", 1 / (z_m * z_m),
                  measured.returns[0].amplitude[0]);
  check_distance(engine, "two paths at 20 MHz", z_m + sensor.ambiguity_m(0) / 6, sensor,
                 measured.returns[0].distance_m[0], 0);
  CHECK(measured.returns[1].amplitude[0] < 1e-6 / (z_m * z_m));
  check_amplitude(engine, "two paths at 75 MHz, amplitude", std::sqrt(2) / (z_m * z_m),
                  measured.returns[2].amplitude[0]);
  check_distance(engine, "two paths at 75 MHz", z_m + sensor.ambiguity_m(2) / 8, sensor,
                 measured.returns[2].distance_m[0], 2);
}

TEST_CASE("the taps of a sine", "[smoke]") {
  const auto taps = GENERATE(3u, 4u, 5u, 16u);
  const double phase_turns = GENERATE(0.0625, 0.3, 0.875);
  Reading expected{{}, 1, phase_turns};
  for (std::uint32_t k = 0; k < taps; ++k)
    expected.taps.push_back(std::cos(full_turn_rad * (phase_turns - static_cast<double>(k) / taps)));
  check_single_path(fmt::format("sine, {} taps, {} turns", taps, phase_turns),
                    sensor_of(Waveform::Kind::sine, taps), phase_turns, expected);
}

TEST_CASE("the taps of square light are the triangle's values") {
  const Sensor four = sensor_of(Waveform::Kind::square, 4), three = sensor_of(Waveform::Kind::square, 3);
  // The triangle falls by 4 a turn from 1 at 0 to -1 at half a turn. The camera sees (c0 - c2) / 2 + j (c1 -
  // c3) / 2 of four taps.
  SECTION("an eighth of a turn") {
    check_single_path("square, 4 taps, 1/8 turn", four, 0.125,
                      {{0.5, 0.5, -0.5, -0.5}, std::sqrt(0.5), 0.125});
  }
  SECTION("a sixteenth") {
    check_single_path("square, 4 taps, 1/16 turn", four, 0.0625,
                      {{0.75, 0.25, -0.75, -0.25}, std::sqrt(0.625), turns_of(0.25, 0.75)});
  }
  SECTION("three quarters") {
    check_single_path("square, 4 taps, 3/4 turn", four, 0.75, {{0, -1, 0, 1}, 1, 0.75});
  }
  SECTION("13/16") {
    check_single_path("square, 4 taps, 13/16 turn", four, 0.8125,
                      {{0.25, -0.75, -0.25, 0.75}, std::sqrt(0.625), turns_of(-0.75, 0.25)});
  }
  SECTION("three taps") {
    // 2/3 (2/3 - 2/3 exp(j 240 degrees)) = 2/3 + j 2/3 sqrt(1/3).
    check_single_path("square, 3 taps, 1/12 turn", three, 1.0 / 12,
                      {{2.0 / 3, 0, -2.0 / 3}, std::sqrt(16.0 / 27), 1.0 / 12});
  }
}

TEST_CASE("the taps of harmonics are their sums of cosines") {
  const Sensor four = sensor_of(Waveform::Kind::harmonics, 4, {1.0, -0.3, 0.2});
  SECTION("an eighth of a turn") {
    // cos 45 - 0.3 cos 90 + 0.2 cos 135 degrees = 0.8 cos 45 degrees, and so on.
    const double c = 0.8 * std::sqrt(0.5);
    check_single_path("harmonics, 4 taps, 1/8 turn", four, 0.125, {{c, c, -c, -c}, 0.8, 0.125});
  }
  SECTION("a sixth") {
    // The phases are 60, -30, -120 and -210 degrees; the third harmonic aliases to 0.2 exp(-j 180 degrees).
    const double c = std::sqrt(0.75);
    check_single_path("harmonics, 4 taps, 1/6 turn", four, 1.0 / 6,
                      {{0.45, c - 0.15, -0.15, -c - 0.15}, std::sqrt(0.84), turns_of(c, 0.3)});
  }
  SECTION("an aliased harmonic") {
    // Five taps see the fourth harmonic as the first backwards: 1 exp(j x) + 0.5 exp(-4 j x), x = 45 degrees.
    const Sensor five = sensor_of(Waveform::Kind::harmonics, 5, {1.0, 0, 0, 0.5});
    Reading expected{
        {}, std::hypot(std::sqrt(0.5) - 0.5, std::sqrt(0.5)), turns_of(std::sqrt(0.5), std::sqrt(0.5) - 0.5)};
    for (int k = 0; k < 5; ++k) {
      const double x_rad = full_turn_rad * (0.125 - k / 5.0);
      expected.taps.push_back(std::cos(x_rad) + 0.5 * std::cos(4 * x_rad));
    }
    check_single_path("harmonics, 5 taps, 1/8 turn", five, 0.125, expected);
  }
}

TEST_CASE("where nothing returns all taps are 0 and the phase is none") {
  const Engine engine = both_engines();
  const auto kind = GENERATE(Waveform::Kind::sine, Waveform::Kind::square, Waveform::Kind::harmonics);
  Sensor sensor = sensor_of(kind, 5, {1.0, 0.5});
  sensor.modulation_hz = {20e6, 60e6};
  Diode turned_away;
  turned_away.axis = {0, 0, -1};
  turned_away.pattern = {Pattern::Kind::cosine, 1.0};
  for (const Scene &scene : {Scene{}, wall_at(2)}) {
    const Measurement measured = measure(engine, scene, sensor, diode_beside_lens(sensor, turned_away),
                                         Backscatter::constant, with_taps);
    REQUIRE(measured.returns.size() == 2);
    for (const Return &got : measured.returns) {
      CHECK(got.amplitude[0] == 0);
      CHECK(std::isnan(got.phase_rad[0]));
      CHECK(std::isnan(got.distance_m[0]));
      REQUIRE(got.taps.size() == 5);
      for (const auto &tap : got.taps)
        CHECK(tap[0] == 0);
    }
  }
}

// Light of 1/16 turn, and half as much of 3/16: taps (0.75, 0.25, ...) + 0.5 (0.25, 0.75, ...).
const Reading mixture{{0.875, 0.625, -0.875, -0.625}, std::hypot(0.875, 0.625), turns_of(0.625, 0.875)};

TEST_CASE("harmonics that the camera's taps cannot tell from none leave amplitude 0 and no phase") {
  const Engine engine = both_engines();
  SceneBuilder builder;
  builder.add_wall({1.7, {0.4}});
  // N taps show the harmonics 1 and N - 1, modulo N.
  for (const auto &[harmonics, taps, shows] :
       std::vector<std::tuple<std::vector<double>, std::uint32_t, bool>>{{{0, 1}, 5, false},
                                                                         {{0, 0, 1}, 3, false},
                                                                         {{0, 0, 1}, 8, false},
                                                                         {{0, 1}, 4, false},
                                                                         {{0, 1}, 3, true},
                                                                         {{0, 0, 1}, 4, true},
                                                                         {{0, 0, 0, 0, 0, 1}, 5, true}}) {
    const Sensor sensor = sensor_of(Waveform::Kind::harmonics, taps, harmonics);
    const Measurement measured =
        measure_monostatic(engine, builder.scene(), sensor, Backscatter::constant, with_taps);
    INFO(harmonics.size() << " harmonics, " << taps << " taps");
    CHECK((measured.returns[0].amplitude[0] > 0) == shows);
    CHECK(std::isfinite(measured.returns[0].distance_m[0]) == shows);
    CHECK(std::isfinite(measured.returns[0].phase_rad[0]) == shows);
  }
}

TEST_CASE("the taps of two diodes' paths add up") {
  const Engine engine = both_engines();
  const Sensor sensor = sensor_of(Waveform::Kind::square, 4);
  const double z_m = wall_m(0.0625, sensor), behind_m = 0.25 * sensor.ambiguity_m();
  Illuminator light = diode_beside_lens(sensor, diode_at({0, 0, 0}));
  light.diodes.push_back(diode_at({0, 0, -behind_m}));
  light.diodes[1].intensity_w_sr = 0.5 * std::pow((z_m + behind_m) / z_m, 2);
  const Measurement measured = measure(engine, wall_at(z_m), sensor, light, Backscatter::constant, with_taps);
  check_reading(engine, "square, two diodes", mixture, sensor, measured, 1 / (z_m * z_m));
}

TEST_CASE("the taps of a pixel's samples add up") {
  const Engine engine = both_engines();
  Sensor sensor = sensor_of(Waveform::Kind::square, 4);
  sensor.samples = 2;
  const double near_m = wall_m(0.0625, sensor), far_m = wall_m(0.1875, sensor);
  SceneBuilder builder;
  builder.add_wall({near_m, {0.5 * near_m * near_m / (far_m * far_m)}, {-9, -9}, {0, 9}});
  builder.add_wall({far_m, {0.25}});
  const Measurement measured =
      measure_monostatic(engine, builder.scene(), sensor, Backscatter::constant, with_taps);
  check_reading(engine, "square, two samples of four near", mixture, sensor, measured,
                0.25 / (far_m * far_m));
}

TEST_CASE("the taps of a pixel's samples add up harmonic by harmonic") {
  const Engine engine = both_engines();
  Sensor sensor = sensor_of(Waveform::Kind::harmonics, 4, {1.0, -0.3, 0.2});
  sensor.samples = 2;
  const double near_m = wall_m(0.125, sensor), far_m = wall_m(1.0 / 6, sensor);
  SceneBuilder builder;
  builder.add_wall({near_m, {0.5 * near_m * near_m / (far_m * far_m)}, {-9, -9}, {0, 9}});
  builder.add_wall({far_m, {0.5}});
  const Measurement measured =
      measure_monostatic(engine, builder.scene(), sensor, Backscatter::constant, with_taps);
  // The taps of an eighth of a turn and of a sixth, as above; 0.8 exp(j 45 degrees) and 0.3 + j sqrt(0.75).
  const double c = 0.8 * std::sqrt(0.5), d = std::sqrt(0.75);
  const Reading expected{{c + 0.45, c + d - 0.15, -c - 0.15, -c - d - 0.15},
                         std::hypot(c + 0.3, c + d),
                         turns_of(c + d, c + 0.3)};
  check_reading(engine, "harmonics, two samples of four near", expected, sensor, measured,
                0.25 / (far_m * far_m));
}
