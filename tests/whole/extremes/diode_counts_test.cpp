// From one diode to 100,000, and samples from 1 to 256 a pixel, against the reference.

#include "engine/reference/reference.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;

namespace {

Illuminator disc(int count, const Sensor &sensor) {
  Illuminator illuminator{"disc", sensor.world_from_camera, {}};
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double radius_m = 0.166 * std::sqrt((i + 0.5) / count), angle = golden_angle * i;
    Diode diode;
    diode.position_m = {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0};
    illuminator.diodes.push_back(diode);
  }
  return illuminator;
}

// The largest distance error in micrometres and relative amplitude error.
std::pair<double, double> largest_errors(const Scene &scene, const Sensor &sensor,
                                         const Illuminator &illuminator,
                                         Backscatter backscatter = Backscatter::lambert) {
  Simulator simulator = test::make_simulator();
  simulator.prepare(scene, sensor, {illuminator}, backscatter);
  const Measurement got = simulator.measure();
  const reference::Frame truth = reference::simulate(scene, sensor, {illuminator}, backscatter);
  double distance_um = 0.0, amplitude = 0.0;
  for (std::size_t i = 0; i < got.returns[0].distance_m.size(); ++i) {
    REQUIRE(std::isfinite(got.returns[0].distance_m[i]));
    REQUIRE(std::isfinite(got.returns[0].amplitude[i]));
    distance_um = std::max(
        distance_um, 1e6 * std::abs(double(got.returns[0].distance_m[i]) - truth.returns[0].distance_m[i]));
    amplitude = std::max(amplitude,
                         std::abs(double(got.returns[0].amplitude[i]) / truth.returns[0].amplitude[i] - 1.0));
  }
  return {distance_um, amplitude};
}

void check_diode_counts(const std::vector<int> &counts) {
  Sensor sensor;
  sensor.resolution = {16, 16};
  sensor.pixel_pitch_m = {1.8e-3, 1.8e-3};
  fmt::print("{:>10} {:>12} {:>16} {:>16}\n", "diodes", "backscatter", "distance max um", "amplitude max");
  for (const auto &[backscatter, name] :
       {std::pair(Backscatter::lambert, "lambert"), std::pair(Backscatter::constant, "constant")})
    for (const int count : counts) {
      const auto [distance_um, amplitude] =
          largest_errors(test::wall_at(2.0), sensor, disc(count, sensor), backscatter);
      fmt::print("{:>10} {:>12} {:>16.3f} {:>16.1e}\n", count, name, distance_um, amplitude);
      CHECK(distance_um <= 2.0);
      CHECK(amplitude <= 1e-5);
    }
}

} // namespace

TEST_CASE("1 to 1025 diodes", "[smoke]") { check_diode_counts({1, 17, 240, 1025}); }

TEST_CASE("1 to 100,000 diodes", "[long]") {
  check_diode_counts({1, 15, 16, 17, 240, 256, 257, 1024, 1025, 4000, 100000});
}

TEST_CASE("beams of any order beside an isotropic diode") {
  // The narrow beam points away: far outside it, it adds nothing, and no NaN.
  Sensor sensor;
  sensor.resolution = {8, 8};
  sensor.pixel_pitch_m = {3.6e-3, 3.6e-3};
  for (const double order : {0.5, 3.5, 100.0, 1e4, 1e6}) {
    Illuminator illuminator = disc(2, sensor);
    illuminator.diodes[1].axis = glm::normalize(glm::dvec3(0.9, 0.0, 1.0));
    illuminator.diodes[1].pattern = {Pattern::Kind::cosine, order};
    const auto [distance_um, amplitude] = largest_errors(test::wall_at(2.0), sensor, illuminator);
    CHECK(distance_um <= 2.0);
    CHECK(amplitude <= 1e-5);
  }
}

TEST_CASE("1 to 256 samples a pixel") {
  Sensor sensor;
  sensor.resolution = {5, 3};
  sensor.pixel_pitch_m = {5e-3, 5e-3};
  fmt::print("{:>10} {:>16} {:>16}\n", "S", "distance max um", "amplitude max");
  for (const std::uint32_t samples : {1u, 2u, 3u, 7u, 16u}) {
    sensor.samples = samples;
    const auto [distance_um, amplitude] = largest_errors(test::wall_at(1.0), sensor, disc(240, sensor));
    fmt::print("{:>10} {:>16.3f} {:>16.1e}\n", samples, distance_um, amplitude);
    CHECK(distance_um <= 2.0);
    CHECK(amplitude <= 1e-5);
  }
}

TEST_CASE("a frame of 8192 columns at 16 samples a side is cut into raster blocks as well") {
  Sensor sensor;
  sensor.resolution = {8192, 1};
  sensor.pixel_pitch_m = {1e-5, 1e-5};
  sensor.samples = 16;
  const auto [distance_um, amplitude] = largest_errors(test::wall_at(2.0), sensor, disc(1, sensor));
  CHECK(distance_um <= 2.0);
  CHECK(amplitude <= 1e-5);
}
