// Several illuminators, with a phase each.

#include "tests/comparison/comparison.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

std::vector<Light> two_lights() {
  std::vector<Light> lights{{light_at({{-0.3, 0, 0}, {-0.3, 0.1, 0}}, 0)},
                            {light_at({{0.4, 0.1, 0.1}}, 90 * degree)}};
  lights[1].illuminator.diodes[0].intensity_w_sr = 0.5;
  return lights;
}

} // namespace

TEST_CASE("two illuminators at different places, a quarter of a turn apart") {
  for (const auto backscatter : {Backscatter::constant, Backscatter::lambert})
    check_wall({.name = "two illuminators", .lights = two_lights(), .backscatter = backscatter});
}

TEST_CASE("an illuminator's phase is delay on top of its paths'") {
  // A wall that all of the image sees at 2 m: 2.5 m of phase behind it reads 4.5 m.
  const Sensor sensor = axial_sensor();
  for (const auto kind : {Waveform::Kind::sine, Waveform::Kind::harmonics})
    for (const SimulatorOptions &options : all_variants()) {
      WallCase one{.name = "", .sensor = sensor, .lights = {{light_at({{0, 0, 0}}, 0)}}};
      one.sensor.waveform = {kind, {1.0}};
      one.lights[0].illuminator.modulation_phase_rad = full_turn_rad * 2.5 / sensor.ambiguity_m();
      CHECK(std::abs(measure(one, options).returns[0].distance_m[0] - 4.5) <= 1e-6);
    }
}

TEST_CASE("a harmonic turns as often as it is") {
  WallCase two{.name = "three harmonics", .lights = two_lights()};
  two.lights[0].illuminator.modulation_phase_rad = -50 * degree;
  two.sensor.waveform = {Waveform::Kind::harmonics, {1.0, -0.3, 0.2}};
  check_wall(two);
}

TEST_CASE("square light has its illuminator's phase") {
  for (const std::uint32_t taps : {4u, 5u}) {
    WallCase two{.name = fmt::format("square, {} taps", taps), .lights = two_lights()};
    two.lights[0].illuminator.modulation_phase_rad = 730 * degree;
    two.sensor.waveform.kind = Waveform::Kind::square;
    two.sensor.taps = taps;
    check_wall(two);
  }
}

TEST_CASE("a whole turn of phase is none, to the bit") {
  WallCase none{.name = "", .lights = two_lights()}, whole = none;
  none.lights[1].illuminator.modulation_phase_rad = 0;
  whole.lights[1].illuminator.modulation_phase_rad = full_turn_rad;
  const Measurement expected = measure(none, {}), measured = measure(whole, {});
  CHECK(measured.returns[0].distance_m == expected.returns[0].distance_m);
  CHECK(measured.returns[0].amplitude == expected.returns[0].amplitude);
}

TEST_CASE("a light close to a far wall") {
  const double z_m = 1000.0;
  SceneBuilder builder; // tilted, so that nothing cancels by symmetry
  builder.add_mesh(
      {{-600, -600, z_m - 200}, {-600, 600, z_m - 200}, {600, 600, z_m + 200}, {600, -600, z_m + 200}},
      {{0, 1, 2}, {0, 2, 3}});
  Sensor sensor;
  sensor.resolution = {32, 32};
  sensor.pixel_pitch_m = glm::dvec2(45e-6);
  const std::vector<Illuminator> lights{diode_beside_lens(sensor, diode_at({0.3, -0.2, z_m - 0.5}))};
  const auto expected = reference::simulate(builder.scene(), sensor, lights, Backscatter::lambert);
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true});
  simulator.prepare(builder.scene(), sensor, lights, Backscatter::lambert);
  const Comparison comparison = compare(simulator.measure(), expected, builder.scene(), sensor);
  fmt::print("{}{}", comparison_heading(),
             comparison_row("light half a metre before a wall at 1 km", comparison));
  CHECK(comparison.pixels >= 500);
  CHECK(comparison.amplitude_max_relative <= 1e-5);
}

TEST_CASE("lights ten metres apart") {
  WallCase far{.name = "10 m apart", .wall_m = 3.0};
  far.lights = {{light_at({{-5, 0, 0}, {-5, 0.1, 0}}, 0)}, {light_at({{5, 0, 0}}, 90 * degree)}};
  check_wall(far);
}
