// Every parameter of the sensor and of its signal, alone and all at once, on the device against the
// reference.

#include "host/input/setup/setup.h"
#include "tests/comparison/comparison.h"
#include "tests/support/simulator.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <functional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Case {
  std::string name;
  std::function<void(Sensor &)> change;
};

Waveform harmonics() { return {Waveform::Kind::harmonics, {1.0, -0.3, 0.2, 0.0, 0.1}}; }

// A view so wide that the image's corners lie 85 degrees off the axis: 170 degrees of view.
void see_170_degrees(Sensor &sensor, const Fisheye &fisheye) {
  const double theta_rad = 85 * degree, u = theta_rad * theta_rad;
  const double radius =
      theta_rad * (1 + u * (fisheye.k1 + u * (fisheye.k2 + u * (fisheye.k3 + u * fisheye.k4))));
  const glm::dvec2 half_chip_m = 0.5 * glm::dvec2(sensor.resolution) * sensor.pixel_pitch_m;
  sensor.focal_length_m = glm::length(half_chip_m) / radius;
  sensor.distortion = fisheye;
}

const std::vector<Case> sensor_cases{
    {"focus at 0.6 m", [](Sensor &s) { s.focus_distance_m = 0.6; }},
    {"pitch 1 : 1.3", [](Sensor &s) { s.pixel_pitch_m.y *= 1.3; }},
    {"inclination 10 degrees",
     [](Sensor &s) {
       s.chip.rotation_rad = {10 * degree, 0, 0};
     }},
    {"tilt about all axes",
     [](Sensor &s) {
       s.chip.rotation_rad = {-7 * degree, 5 * degree, 20 * degree};
     }},
    {"chip off-axis by 1 and 2 mm",
     [](Sensor &s) {
       s.chip.translation_m = {1e-3, -2e-3, 5e-4};
     }},
    {"fill factor 0.6 x 0.4",
     [](Sensor &s) {
       s.fill_factor = {0.6, 0.4};
     }},
    {"cos^4 vignetting", [](Sensor &s) { s.vignetting = Vignetting::cos4; }},
    {"barrel -0.3",
     [](Sensor &s) {
       s.distortion = BrownConrady{-0.3, 0, 0, 0, 0};
     }},
    // It folds where slopes are 2/3 / sqrt(0.9) = 0.7027 on the chip.
    {"barrel -0.3, corners 0.1 % before the fold",
     [](Sensor &s) {
       s.distortion = BrownConrady{-0.3, 0, 0, 0, 0};
       s.focal_length_m = 0.5 * glm::length(glm::dvec2(s.resolution) * s.pixel_pitch_m) / (0.999 * 0.70273);
     }},
    {"pincushion 0.2",
     [](Sensor &s) {
       s.distortion = BrownConrady{0.2, 0, 0, 0, 0};
     }},
    {"all of Brown and Conrady's",
     [](Sensor &s) {
       s.distortion = BrownConrady{-0.2, 0.1, 0.01, -0.02, 0.02};
     }},
    {"S-shaped along the radius",
     [](Sensor &s) {
       s.distortion = BrownConrady{0.65183584760808377, -0.074661211230573163, 0, 0, 0.0013451963068898329};
       s.focal_length_m = 0.006;
     }},
    {"fisheye, equidistant", [](Sensor &s) { see_170_degrees(s, {}); }},
    {"fisheye, its four coefficients",
     [](Sensor &s) {
       see_170_degrees(s, {-0.03, 0.01, -0.004, 0.0005});
     }},
    {"fisheye beyond 90 degrees",
     [](Sensor &s) {
       see_170_degrees(s, {});
       s.focal_length_m *= 0.6;
     }},
    {"fisheye, tilted, filled in part, cos^4",
     [](Sensor &s) {
       see_170_degrees(s, {-0.03, 0.01, -0.004, 0.0005});
       s.chip.rotation_rad = {3 * degree, -4 * degree, 10 * degree};
       s.fill_factor = {0.7, 0.5};
       s.vignetting = Vignetting::cos4;
     }},
};

const std::vector<Case> signal_cases{
    {"20, 60 and 100 MHz",
     [](Sensor &s) {
       s.modulation_hz = {20e6, 60e6, 100e6};
     }},
    {"square, 3 taps", [](Sensor &s) { s.waveform.kind = Waveform::Kind::square, s.taps = 3; }},
    {"square, 4 taps", [](Sensor &s) { s.waveform.kind = Waveform::Kind::square, s.taps = 4; }},
    {"square, 5 taps, 2 frequencies",
     [](Sensor &s) {
       s.waveform.kind = Waveform::Kind::square;
       s.taps = 5;
       s.modulation_hz = {20e6, 31e6};
     }},
    {"square, 8 taps", [](Sensor &s) { s.waveform.kind = Waveform::Kind::square, s.taps = 8; }},
    {"square, 16 taps", [](Sensor &s) { s.waveform.kind = Waveform::Kind::square, s.taps = 16; }},
    {"five harmonics, 4 taps", [](Sensor &s) { s.waveform = harmonics(); }},
    {"five harmonics, 7 taps, 2 frequencies",
     [](Sensor &s) {
       s.waveform = harmonics();
       s.taps = 7;
       s.modulation_hz = {20e6, 31e6};
     }},
};

const std::vector<Case> everything{
    {"all at once",
     [](Sensor &s) {
       s.samples = 3;
       s.chip.rotation_rad = {10 * degree, 0, 0};
       s.chip.translation_m = {1e-3, 0, 0};
       s.distortion = BrownConrady{-0.3, 0, 0, 0, 0};
       s.fill_factor = {0.6, 0.4};
       s.modulation_hz = {20e6, 60e6, 100e6};
       s.taps = 5;
     }},
    {"all at once, fisheye, square light, cos^4",
     [](Sensor &s) {
       see_170_degrees(s, {-0.03, 0.01, -0.004, 0.0005});
       s.samples = 3;
       s.chip.rotation_rad = {-3 * degree, 2 * degree, 30 * degree};
       s.chip.translation_m = {1e-4, -2e-4, 0};
       s.fill_factor = {0.6, 0.4};
       s.vignetting = Vignetting::cos4;
       s.waveform.kind = Waveform::Kind::square;
       s.modulation_hz = {20e6, 31e6};
       s.taps = 5;
     }},
};

// The options for this device, and those for other devices with the sum of moments as such.
const std::vector<SimulatorOptions> variants{
    {.device = {}, .keep_sample_ids = true, .keep_taps = true},
    {.device = {},
     .keep_sample_ids = true,
     .keep_taps = true,
     .precision = SamplePrecision::double_float,
     .loop = DiodeLoop::looped,
     .allowed = {.polynomial_moments = false}},
};

// A room whose camera sees all of the image filled, on a chip of 24 x 16 mm behind a lens of 30 mm.
Sensor wide_sensor(const Sensor &of_room, const glm::uvec2 &resolution) {
  Sensor sensor = of_room;
  sensor.resolution = resolution;
  sensor.focal_length_m = 0.03;
  sensor.pixel_pitch_m = glm::dvec2(24e-3, 16e-3) / glm::dvec2(resolution);
  return sensor;
}

void check_case(const Case &changed, const Setup &setup, Sensor sensor) {
  changed.change(sensor);
  const auto expected =
      reference::simulate(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  for (const SimulatorOptions &options : variants) {
    const bool plain = options.allowed.polynomial_moments;
    const std::string name =
        fmt::format("{}, S = {}{}", changed.name, sensor.samples, plain ? "" : ", others'");
    INFO(name);
    Simulator simulator = make_simulator(options);
    simulator.prepare(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
    const Comparison comparison = compare(simulator.measure(), expected, setup.start.scene, sensor);
    fmt::print("{}", comparison_row(name, comparison));
    check_comparison(comparison, sensor.pixel_count() / 4);
  }
}

// Every `step`-th case of the sensor.
void check_sensor_cases(std::size_t step, const std::vector<std::uint32_t> &samples_a_side) {
  const Setup setup = load_setup(PMDSIM_SCENES "/room.json");
  Sensor sensor = wide_sensor(setup.start.sensors[0], {180, 120});
  fmt::print("{}", comparison_heading());
  for (const std::uint32_t samples : samples_a_side) {
    sensor.samples = samples;
    for (std::size_t i = 0; i < sensor_cases.size(); i += step)
      check_case(sensor_cases[i], setup, sensor);
  }
}

void check_signal_cases(std::size_t step) {
  const Setup setup = load_setup(PMDSIM_SCENES "/room.json");
  Sensor sensor = wide_sensor(setup.start.sensors[0], {150, 100});
  sensor.samples = 2;
  fmt::print("{}", comparison_heading());
  for (std::size_t i = 0; i < signal_cases.size(); i += step)
    check_case(signal_cases[i], setup, sensor);
}

} // namespace

TEST_CASE("some parameters of the sensor agree with the reference") { check_sensor_cases(9, {2}); }

TEST_CASE("every parameter of the sensor agrees with the reference", "[long]") {
  check_sensor_cases(1, {1, 2});
}

TEST_CASE("some parameters of the signal agree with the reference") { check_signal_cases(9); }

TEST_CASE("every parameter of the signal agrees with the reference", "[long]") { check_signal_cases(1); }

TEST_CASE("all parameters at once agree with the reference", "[long]") {
  const Setup setup = load_setup(PMDSIM_SCENES "/room.json");
  fmt::print("{}", comparison_heading());
  for (const Case &changed : everything)
    check_case(changed, setup, wide_sensor(setup.start.sensors[0], {240, 160}));
}
