// Sums, and what becomes of a frame when it is rounded to float.

#include "engine/reference/signal/channels.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("a compensated sum keeps what a plain one loses") {
  reference::CompensatedSum sum;
  for (const double term : {1.0, 1e100, 1.0, -1e100})
    sum.add(term);
  CHECK(sum.value() == 2);

  reference::CompensatedSum tenths;
  for (int i = 0; i < 1000000; ++i)
    tenths.add(0.1);
  CHECK(tenths.value() == 100000);
}

TEST_CASE("phase and distance stay below their range's end when rounded to float") {
  const Sensor sensor = axial_sensor();
  reference::Frame frame = reference::dark_frame(sensor);
  reference::PixelSums sums(sensor);
  sums.returns[0].add({{-2 * sensor.ambiguity_m() * GENERATE(1e-9, 1e-16, 1e-18, 1e-300), 1.0}});
  reference::set_channels(frame, 0, sums, 1);
  CHECK(frame.returns[0].phase_rad[0] < 2 * std::numbers::pi);
  CHECK(frame.returns[0].distance_m[0] < frame.returns[0].ambiguity_m);

  const Measurement measurement = reference::to_measurement(frame);
  CHECK(measurement.returns[0].phase_rad[0] >= 0);
  CHECK(static_cast<double>(measurement.returns[0].phase_rad[0]) < 2 * std::numbers::pi);
  CHECK(measurement.returns[0].distance_m[0] >= 0);
  CHECK(static_cast<double>(measurement.returns[0].distance_m[0]) < frame.returns[0].ambiguity_m);
}

TEST_CASE("a frame is rounded channel by channel") {
  Sensor sensor = axial_sensor({2, 1});
  sensor.pixel_pitch_m = glm::dvec2(0.5);
  sensor.modulation_hz = {20e6, 70e6};
  sensor.taps = 3;
  SceneBuilder builder;
  builder.add_wall({2, {0.3}, {-9, -9}, {0, 9}});
  const auto frame = reference::simulate(
      builder.scene(), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::lambert);
  const Measurement measurement = reference::to_measurement(frame);
  CHECK(measurement.resolution == sensor.resolution);
  REQUIRE(measurement.returns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const Return &rounded = measurement.returns[i];
    const reference::FrameReturn &exact = frame.returns[i];
    CHECK(rounded.amplitude[0] == static_cast<float>(exact.amplitude[0]));
    CHECK(rounded.phase_rad[0] == static_cast<float>(exact.phase_rad[0]));
    CHECK(rounded.distance_m[0] == static_cast<float>(exact.distance_m[0]));
    REQUIRE(rounded.taps.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(rounded.taps[k] == std::vector<float>{static_cast<float>(exact.taps[k][0]), 0});
  }
  CHECK(measurement.range_m[0] == static_cast<float>(frame.range_m[0]));
  CHECK(measurement.z_m[0] == static_cast<float>(frame.z_m[0]));
  CHECK(measurement.coverage == std::vector<float>{1, 0});
  CHECK(measurement.triangle_id == frame.triangle_id);
  CHECK(measurement.object_id == std::vector<std::uint32_t>{0, no_id});
  CHECK(measurement.returns[0].amplitude[1] == 0);
  for (const auto *channel : {&measurement.returns[0].phase_rad, &measurement.returns[0].distance_m,
                              &measurement.range_m, &measurement.z_m})
    CHECK(std::isnan((*channel)[1]));
}

TEST_CASE("two runs give the same bits") {
  Random random(21);
  const Pose world_from_camera = random.pose(5);
  const Scene scene = random_triangles(random, 80, world_from_camera);
  const Illuminator illuminator = random_illuminator(random, 20, world_from_camera);
  Sensor sensor;
  sensor.resolution = {40, 30};
  sensor.pixel_pitch_m = glm::dvec2(4e-3);
  sensor.world_from_camera = world_from_camera;
  sensor.samples = 2;
  const auto first = reference::simulate(scene, sensor, {illuminator}, Backscatter::lambert);
  const auto second = reference::simulate(scene, sensor, {illuminator}, Backscatter::lambert);
  CHECK(std::memcmp(first.returns[0].z.data(), second.returns[0].z.data(),
                    first.returns[0].z.size() * sizeof(first.returns[0].z[0])) == 0);
  CHECK(first.sample_triangle_id == second.sample_triangle_id);
}
