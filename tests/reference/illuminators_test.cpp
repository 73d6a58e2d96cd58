// Several lights, each with a phase of its own.

#include "engine/reference/reference.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using std::numbers::pi;

Illuminator monostatic_with_phase(const Sensor &sensor, double phase_rad) {
  Illuminator light = monostatic_illuminator(sensor.world_from_camera);
  light.modulation_phase_rad = phase_rad;
  return light;
}

// C(x - 2 pi k / N) of one path of weight 1 and length 4 m, k along the result.
std::vector<double> taps_of_wall(const Waveform &waveform, double phase_rad) {
  Sensor sensor = axial_sensor();
  sensor.waveform = waveform;
  sensor.taps = 5;
  const auto frame = reference::simulate(wall_at(2), sensor, {monostatic_with_phase(sensor, phase_rad)},
                                         Backscatter::constant);
  std::vector<double> taps;
  for (const auto &tap : frame.returns[0].taps)
    taps.push_back(4 * tap[0]);
  return taps;
}

double path_phase_rad() { return 2 * pi * Sensor{}.modulation_hz[0] * 4 / speed_of_light_m_s; }

double triangle_wave(double x) { return 1 - std::abs(std::remainder(x, 2 * pi)) / (pi / 2); }

} // namespace

TEST_CASE("the frame of two lights is the sum of their frames") {
  Random random(51);
  const Pose world_from_camera = random.pose(3);
  const Scene scene = random_triangles(random, 60, world_from_camera);
  Sensor sensor;
  sensor.resolution = {16, 12};
  sensor.pixel_pitch_m = glm::dvec2(0.01);
  sensor.world_from_camera = world_from_camera;
  const auto kind = GENERATE(Waveform::Kind::sine, Waveform::Kind::square, Waveform::Kind::harmonics);
  sensor.waveform = {kind, {0.9, 0.0, 0.1}};
  Illuminator beside = random_illuminator(random, 4, world_from_camera);
  beside.modulation_phase_rad = 0.7;
  // Placed freely: above the camera, towards the scene.
  Illuminator above =
      random_illuminator(random, 3, compose(world_from_camera, {glm::dmat3(1), glm::dvec3(0.1, -1, 0.3)}));
  above.modulation_phase_rad = -2.1;

  const auto both = reference::simulate(scene, sensor, {beside, above}, Backscatter::lambert);
  const auto first = reference::simulate(scene, sensor, {beside}, Backscatter::lambert);
  const auto second = reference::simulate(scene, sensor, {above}, Backscatter::lambert);
  double largest_error = 0, largest = 0;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    const auto sum = first.returns[0].z[pixel] + second.returns[0].z[pixel];
    largest_error = std::max(largest_error, std::abs(both.returns[0].z[pixel] - sum));
    largest = std::max(largest,
                       std::min(std::abs(first.returns[0].z[pixel]), std::abs(second.returns[0].z[pixel])));
  }
  CHECK(largest > 0.01);
  CHECK(largest_error < 1e-14);
}

TEST_CASE("a light's phase moves the distance by c delta / (4 pi f), wrapped") {
  const double phase_deg = GENERATE(0.0, 30.0, 90.0, -45.0, 180.0, 300.0, -300.0, 3690.0);
  const double phase_rad = phase_deg * pi / 180;
  Sensor sensor = axial_sensor();
  sensor.modulation_hz = {20e6, 15e6};
  const auto frame = reference::simulate(wall_at(2), sensor, {monostatic_with_phase(sensor, phase_rad)},
                                         Backscatter::constant);
  for (std::size_t i = 0; i < 2; ++i) {
    const double ambiguity_m = sensor.ambiguity_m(i);
    double expected_m =
        std::fmod(2 + speed_of_light_m_s * phase_rad / (4 * pi * sensor.modulation_hz[i]), ambiguity_m);
    expected_m += expected_m < 0 ? ambiguity_m : 0;
    CHECK(frame.returns[i].distance_m[0] == Approx(expected_m).epsilon(0).margin(1e-10));
    CHECK(frame.returns[i].amplitude[0] == Approx(0.25).epsilon(1e-10));
  }
}

TEST_CASE("two equal lights in opposite phase leave nothing, a quarter apart the root of two") {
  const Sensor sensor = axial_sensor();
  const auto amplitude = [&](double phase_rad) {
    return reference::simulate(wall_at(2), sensor,
                               {monostatic_with_phase(sensor, 0), monostatic_with_phase(sensor, phase_rad)},
                               Backscatter::constant)
        .returns[0]
        .amplitude[0];
  };
  CHECK(amplitude(0) == Approx(0.5).epsilon(1e-10));
  CHECK(amplitude(pi / 2) == Approx(std::sqrt(0.5) / 2).epsilon(1e-10));
  CHECK(amplitude(pi) < 1e-15);
}

TEST_CASE("a light's phase is the correlation's, whatever the waveform") {
  const double phase_rad = GENERATE(0.4, -1.3, 2.9, 20.0);
  const auto square = taps_of_wall({Waveform::Kind::square, {}}, phase_rad);
  const auto harmonics = taps_of_wall({Waveform::Kind::harmonics, {0.8, 0.0, 0.2}}, phase_rad);
  const auto sine = taps_of_wall({}, phase_rad);
  for (std::size_t k = 0; k < 5; ++k) {
    const double x = path_phase_rad() + phase_rad - 2 * pi * static_cast<double>(k) / 5;
    CHECK(square[k] == Approx(triangle_wave(x)).epsilon(0).margin(1e-10));
    CHECK(harmonics[k] == Approx(0.8 * std::cos(x) + 0.2 * std::cos(3 * x)).epsilon(0).margin(1e-10));
    CHECK(sine[k] == Approx(std::cos(x)).epsilon(0).margin(1e-10));
  }
}

TEST_CASE("a phase of one light leaves the other's alone") {
  const Sensor sensor = axial_sensor();
  Illuminator weak = monostatic_with_phase(sensor, 1.0);
  weak.diodes[0].intensity_w_sr = 0.5;
  const auto frame = reference::simulate(wall_at(2), sensor, {monostatic_with_phase(sensor, 0), weak},
                                         Backscatter::constant);
  const auto expected =
      0.25 * std::polar(1.0, path_phase_rad()) + 0.125 * std::polar(1.0, path_phase_rad() + 1.0);
  CHECK(std::abs(frame.returns[0].z[0] - expected) < 1e-10);
}

TEST_CASE("without lights it is dark") {
  const Sensor sensor = axial_sensor();
  CHECK(reference::simulate(wall_at(2), sensor, {}, Backscatter::constant).returns[0].amplitude[0] == 0);
}
