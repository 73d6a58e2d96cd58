// The mean light beside the judge's: of every waveform, form of the sum, depth and phase of illuminators.

#include "engine/reference/reference.h"
#include "tests/electronics/fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <functional>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Scene slanted() {
  SceneBuilder builder;
  builder.add_mesh({{-3, -3, 2.5}, {1.1, -3, 1.5}, {1.1, 3, 1.9}, {-3, 3, 2.9}}, {{0, 2, 1}, {0, 3, 2}});
  builder.add_wall({1.0, {.reflectivity = 0.7}, {0.05, -0.1}, {0.2, 0.15}});
  return builder.scene();
}

Sensor wide_sensor() {
  Sensor sensor;
  sensor.resolution = {40, 30};
  sensor.pixel_pitch_m = {60e-6, 60e-6};
  sensor.focal_length_m = 0.003;
  sensor.modulation_hz = {20e6, 90e6};
  sensor.electronics = plain_electronics();
  return sensor;
}

std::vector<Illuminator> boards(const Sensor &sensor, int diodes) {
  std::vector<Illuminator> lights;
  for (const double side : {-1.0, 1.0}) {
    Illuminator light = diode_beside_lens(sensor, diode_at({0.1 * side, 0.0, 0.0}));
    light.diodes.clear();
    for (int i = 0; i < diodes; ++i) {
      Diode diode = diode_at({0.1 * side + 0.002 * (i % 7), 0.003 * (i / 7), 0.0});
      diode.pattern = cosine(2.0);
      light.diodes.push_back(diode);
    }
    lights.push_back(light);
  }
  lights[0].modulation_depth = 0.9;
  lights[1].modulation_depth = 0.4;
  lights[1].modulation_phase_rad = 1.0;
  return lights;
}

Accuracy within_error(Mode mode) {
  Accuracy accuracy;
  accuracy.mode = mode;
  accuracy.max_error_m = 1e-4;
  return accuracy;
}

Accuracy in_fp64() {
  Accuracy accuracy;
  accuracy.precision = Precision::fp64;
  return accuracy;
}

struct MeanCase {
  std::string name;
  std::function<void(Sensor &)> change = [](Sensor &) {};
  SimulatorOptions options{};
  Shadows shadows = Shadows::automatic;
  Accuracy accuracy{};
  Backscatter backscatter = Backscatter::lambert;
};

std::vector<MeanCase> mean_cases() {
  const auto forbidding = [](const std::function<void(PathForms &)> &change) {
    SimulatorOptions options;
    change(options.allowed);
    return options;
  };
  return {
      {"all on the host"},
      {"without shadows", [](Sensor &) {}, {}, Shadows::off},
      {"the paper's backscatter", [](Sensor &) {}, {}, Shadows::off, {}, Backscatter::constant},
      {"square light", [](Sensor &s) { s.waveform.kind = Waveform::Kind::square; }},
      {"square light, 3 taps",
       [](Sensor &s) {
         s.waveform.kind = Waveform::Kind::square;
         s.taps = 3;
       }},
      {"harmonics",
       [](Sensor &s) {
         s.waveform = {Waveform::Kind::harmonics, {1.0, -0.3, -1.0}};
       }},
      {"3 x 3 samples", [](Sensor &s) { s.samples = 3; }},
      {"adaptive samples",
       [](Sensor &s) {
         s.samples = 4;
         s.adaptive_samples = true;
       }},
      {"vignetting, filled in part",
       [](Sensor &s) {
         s.vignetting = Vignetting::cos4;
         s.fill_factor = {0.7, 0.6};
         s.samples = 2;
       }},
      {"distortion",
       [](Sensor &s) {
         s.distortion = BrownConrady{-0.05, 0.01, 0, 0, 0};
       }},
      {"on the device", [](Sensor &) {},
       forbidding([](PathForms &f) { f.host_pixels = f.host_sum = f.host_raster = f.host_sweep = false; })},
      {"points", [](Sensor &) {}, forbidding([](PathForms &f) { f.depth_records = false; })},
      {"not at once", [](Sensor &) {},
       forbidding([](PathForms &f) { f.host_pixels = f.direct_pixels = f.host_sum = false; })},
      {"diode by diode, without powers", [](Sensor &) {},
       forbidding([](PathForms &f) { f.polynomial_moments = f.host_sum = f.host_pixels = false; })},
      {"float pairs, loops",
       [](Sensor &) {},
       {.device = {}, .precision = SamplePrecision::double_float, .loop = DiodeLoop::looped}},
      {"fp64", [](Sensor &) {}, {}, Shadows::automatic, in_fp64()},
      {"fp64, square light",
       [](Sensor &s) { s.waveform.kind = Waveform::Kind::square; },
       {},
       Shadows::automatic,
       in_fp64()},
      {"within 0.1 mm", [](Sensor &) {}, {}, Shadows::automatic, within_error(Mode::automatic)},
      {"within 0.1 mm, bounds kept",
       [](Sensor &) {},
       {.device = {}, .keep_error_bound = true},
       Shadows::off,
       within_error(Mode::automatic)},
      {"reduced", [](Sensor &) {}, {}, Shadows::off, within_error(Mode::reduced)},
      {"reduced, no shortcuts", [](Sensor &s) { s.samples = 2; },
       forbidding([](PathForms &f) { f.unsorted = f.incident_field = false; }), Shadows::automatic,
       within_error(Mode::reduced)},
  };
}

double largest_error(const MeanCase &of, int diodes) {
  Sensor sensor = wide_sensor();
  of.change(sensor);
  const Scene scene = slanted();
  const std::vector<Illuminator> lights = boards(sensor, diodes);
  const reference::Frame truth =
      reference::simulate(scene, sensor, lights, of.backscatter, {.shadows = of.shadows});
  Simulator simulator = make_simulator(of.options);
  simulator.prepare(scene, sensor, lights, of.backscatter, of.shadows, of.accuracy);
  const Measurement found = simulator.measure();
  REQUIRE(found.returns.size() == sensor.modulation_hz.size());
  REQUIRE(found.mean_radiance.size() == sensor.pixel_count());
  const double typical = truth.mean_radiance[sensor.pixel_count() / 2];
  double largest = 0.0;
  for (std::size_t i = 0; i < found.mean_radiance.size(); ++i) {
    // Where an edge or a shadow's passes within rounding, a sample may see other things.
    if (found.coverage[i] != static_cast<float>(truth.coverage[i]) ||
        (!truth.lit.empty() && !found.lit.empty() && found.lit[i] != static_cast<float>(truth.lit[i])))
      continue;
    const double expected = truth.mean_radiance[i], off = std::abs(found.mean_radiance[i] - expected);
    largest = std::max(largest, off / std::max(expected, 1e-3 * typical));
  }
  return largest;
}

void check_mean_light(const std::vector<MeanCase> &cases) {
  fmt::print("{:<44}{:>14}{:>14}\n", "mean radiance, largest relative error", "14 diodes", "300 diodes");
  for (const MeanCase &of : cases) {
    const double few = largest_error(of, 7), many = largest_error(of, 150);
    fmt::print("{:<44}{:>14.2e}{:>14.2e}\n", of.name, few, many);
    INFO(of.name);
    const double allowed = of.accuracy.mode == Mode::exact ? 2e-5 : 1e-3;
    CHECK(few < allowed);
    CHECK(many < allowed);
  }
}

} // namespace

TEST_CASE("the mean light is the judge's, in some of the ways to sum it") {
  check_mean_light(every_third(mean_cases()));
}

TEST_CASE("the mean light is the judge's, whichever way it is summed", "[long]") {
  check_mean_light(mean_cases());
}

TEST_CASE("without electronics there is no mean light") {
  Sensor sensor = wide_sensor();
  sensor.electronics.reset();
  Simulator simulator = make_simulator();
  simulator.prepare(slanted(), sensor, boards(sensor, 7), Backscatter::lambert, Shadows::off);
  CHECK(simulator.measure().mean_radiance.empty());
}
