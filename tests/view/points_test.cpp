// Points: a point counts by the area that it covers, and faces the lens.

#include "tests/comparison/engines.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// One pixel of 0.2 x 0.2 m at 2 m, 16 x 16 samples.
Sensor one_pixel() {
  Sensor sensor;
  sensor.resolution = {1, 1};
  sensor.pixel_pitch_m = glm::dvec2(0.01);
  sensor.focal_length_m = 0.1;
  sensor.samples = 16;
  return sensor;
}

Scene point_at(const glm::dvec3 &camera_m, double radius_m) {
  Scene scene;
  scene.positions_m = {node_from_camera().point(camera_m)};
  scene.surfaces = {{0.8, false}};
  scene.objects = {"point"};
  scene.discs = {{0, radius_m, 0, 0}};
  return scene;
}

} // namespace

TEST_CASE("a point covers its area") {
  const Engine engine = both_engines();
  const double radius_m = GENERATE(0.02, 0.05, 0.08);
  const Measurement measured = measure_monostatic(engine, point_at({0.01, -0.005, 2}, radius_m), one_pixel());
  // On a grid of 256 samples a circle of radius r cuts about 2 pi r of the cells' edges; they err at random.
  const double share = std::numbers::pi * radius_m * radius_m / 0.04;
  check_within(engine, "share of the pixel that a point covers", share, measured.coverage[0], 0.02);
  check_within(engine, "its amplitude over coverage", 0.8 / 4.0,
               static_cast<double>(measured.returns[0].amplitude[0]) /
                   static_cast<double>(measured.coverage[0]),
               1e-3);
  CHECK(measured.triangle_id[0] == 0);
}

TEST_CASE("a point faces the lens, wherever it lies") {
  const Engine engine = both_engines();
  Sensor sensor = one_pixel();
  sensor.resolution = {21, 21};
  sensor.samples = 1;
  // Off the axis by 31 degrees, seen by the pixel that looks at its centre: lambert's cosine is 1.
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.6, 0.0, 1.0));
  const Measurement measured =
      measure_monostatic(engine, point_at(3.0 * direction, 0.2), sensor, Backscatter::lambert);
  const std::size_t pixel = 10 * 21 + 16;
  check_amplitude(engine, "a point 31 degrees off the axis", 0.8 / std::numbers::pi / 9.0,
                  measured.returns[0].amplitude[pixel]);
  check_distance(engine, "a point 31 degrees off the axis", 3.0, sensor,
                 measured.returns[0].distance_m[pixel]);
}

TEST_CASE("a point hides what is behind it and is hidden by what is before it") {
  const Engine engine = both_engines();
  Scene scene = point_at({0, 0, 2}, 0.5);
  scene.discs.push_back({1, 0.5, 0, 0});
  scene.positions_m.push_back(node_from_camera().point({0, 0, 1.5}));
  const Sensor sensor = axial_sensor();
  const Measurement measured = measure_monostatic(engine, scene, sensor);
  check_distance(engine, "the nearer of two points", 1.5, sensor, measured.returns[0].distance_m[0]);
  CHECK(measured.triangle_id[0] == 1);
}
