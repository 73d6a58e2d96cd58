// Closed forms over ranges of a parameter, with scenes built here.

#include "tests/comparison/engines.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A pixel in the middle of each image quarter sees the direction (+-0.25, +-0.25, 1).
Sensor two_by_two_sensor() {
  Sensor sensor;
  sensor.resolution = {2, 2};
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(0.05);
  return sensor;
}

} // namespace

TEST_CASE("distance over modulation frequency and range") {
  const Engine engine = both_engines();
  Sensor sensor = axial_sensor();
  for (const double modulation_hz : {1e6, 20e6, 100e6, 300e6})
    for (const double z_m : {0.1, 3.3, 70.0, 1000.0}) {
      sensor.modulation_hz = {modulation_hz};
      const double baseline_m = 0.07;
      const Measurement frame =
          measure(engine, wall_at(z_m), sensor, diode_beside_lens(sensor, diode_at({0, baseline_m, 0})),
                  Backscatter::lambert);
      check_distance(engine, fmt::format("7 cm baseline, {:g} MHz, {:g} m", modulation_hz / 1e6, z_m),
                     (z_m + std::hypot(z_m, baseline_m)) / 2, sensor, frame.returns[0].distance_m[0]);
    }
}

TEST_CASE("distance along oblique rays") {
  const Engine engine = both_engines();
  const Sensor sensor = two_by_two_sensor();
  const glm::dvec3 diode_m(0.1, -0.2, 0.05);
  const Measurement frame =
      measure(engine, wall_at(2), sensor, diode_beside_lens(sensor, diode_at(diode_m)), Backscatter::lambert);
  const std::vector<glm::dvec3> points_m{{-0.5, -0.5, 2}, {0.5, -0.5, 2}, {-0.5, 0.5, 2}, {0.5, 0.5, 2}};
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    const double lens_m = glm::length(points_m[pixel]), light_m = glm::length(points_m[pixel] - diode_m);
    const std::string name = fmt::format("oblique ray {}", pixel);
    check_distance(engine, name, (lens_m + light_m) / 2, sensor, frame.returns[0].distance_m[pixel]);
    check_distance(engine, name + ", range", lens_m, sensor, frame.range_m[pixel]);
    check_distance(engine, name + ", z", 2, sensor, frame.z_m[pixel]);
    const double cos_incidence = (2 - diode_m.z) / light_m;
    check_amplitude(engine, name + ", amplitude", cos_incidence / (std::numbers::pi * light_m * light_m),
                    frame.returns[0].amplitude[pixel]);
  }
}

TEST_CASE("a camera far from the world's origin measures as one at it") {
  const Engine engine = both_engines();
  Sensor sensor = two_by_two_sensor();
  sensor.world_from_camera = {Random(3).pose(1).rotation, {1e7, -1e7, 1e7}};
  SceneBuilder builder(sensor.world_from_camera);
  builder.add_wall({2});
  const Measurement frame = measure(engine, builder.scene(), sensor,
                                    monostatic_illuminator(sensor.world_from_camera), Backscatter::constant);
  for (std::size_t pixel = 0; pixel < 4; ++pixel)
    check_distance(engine, fmt::format("1e7 m from the origin, pixel {}", pixel), 2 * std::sqrt(1.125),
                   sensor, frame.returns[0].distance_m[pixel]);
}

TEST_CASE("a diode's diagram over order and angle") {
  const Engine engine = both_engines();
  const Sensor sensor = axial_sensor();
  for (const double order : {0.0, 1.0, 2.0, 3.7, 30.0, 100.0})
    for (const double angle_rad : {0.0, 0.3, 0.8}) {
      Diode diode;
      diode.axis = {std::sin(angle_rad), 0, std::cos(angle_rad)};
      diode.pattern = {Pattern::Kind::cosine, order};
      const Measurement frame =
          measure(engine, wall_at(1), sensor, diode_beside_lens(sensor, diode), Backscatter::constant);
      check_amplitude(engine, fmt::format("cos^{:g} of {:g} rad", order, angle_rad),
                      std::pow(std::cos(angle_rad), order), frame.returns[0].amplitude[0]);
    }
}

TEST_CASE("a diode turned away or behind the surface gives no light and no distance") {
  const Engine engine = both_engines();
  const Sensor sensor = axial_sensor();
  Diode turned_away;
  turned_away.axis = {0, 0, -1};
  turned_away.pattern = {Pattern::Kind::cosine, GENERATE(0.0, 1.0, 2.0)};
  const Diode behind_wall = diode_at({0, 0.1, 3});
  for (const Diode &diode : {turned_away, behind_wall}) {
    const Measurement frame =
        measure(engine, wall_at(2), sensor, diode_beside_lens(sensor, diode), Backscatter::constant);
    CHECK(frame.returns[0].amplitude[0] == 0);
    CHECK(std::isnan(frame.returns[0].phase_rad[0]));
    CHECK(std::isnan(frame.returns[0].distance_m[0]));
    CHECK(frame.coverage[0] == 1);
    CHECK(frame.range_m[0] == Approx(2));
  }
}

TEST_CASE("a back face is seen only where it is double-sided") {
  const Engine engine = both_engines();
  const bool double_sided = GENERATE(false, true);
  const Sensor sensor = two_by_two_sensor();
  SceneBuilder builder;
  builder.add_triangle({-9, -9, 1}, {9, 9, 1}, {-9, 9, 1},
                       {1.0, double_sided}); // lower left half, seen from behind
  builder.add_wall({2});
  const Measurement frame = measure(engine, builder.scene(), sensor,
                                    monostatic_illuminator(sensor.world_from_camera), Backscatter::lambert);
  CHECK(frame.triangle_id[2] == (double_sided ? 0 : 1));
  CHECK(frame.object_id[2] == (double_sided ? 0 : 1));
  check_distance(engine, double_sided ? "double-sided back face" : "culled back face",
                 (double_sided ? 1 : 2) * std::sqrt(1.125), sensor, frame.returns[0].distance_m[2]);
}

TEST_CASE("what misses counts in the light, not in the range") {
  const Engine engine = both_engines();
  Sensor sensor = axial_sensor();
  SceneBuilder builder;
  builder.add_wall({2, {}, {-3, -3}, {0, 3}});
  for (const std::uint32_t samples : {2u, 4u, 16u}) {
    sensor.samples = samples;
    const Measurement frame =
        measure(engine, builder.scene(), sensor, monostatic_illuminator(sensor.world_from_camera),
                Backscatter::constant);
    const std::string name = fmt::format("half-covered pixel, S = {}", samples);
    CHECK(frame.coverage[0] == 0.5f);
    check_amplitude(engine, name + ", amplitude", 0.125, frame.returns[0].amplitude[0]);
    check_distance(engine, name + ", distance", 2, sensor, frame.returns[0].distance_m[0]);
    check_distance(engine, name + ", range", 2, sensor, frame.range_m[0]);
  }
}

TEST_CASE("an empty scene is dark and without distance") {
  const Engine engine = both_engines();
  const Sensor sensor = two_by_two_sensor();
  const Measurement frame =
      measure(engine, {}, sensor, monostatic_illuminator(sensor.world_from_camera), Backscatter::lambert);
  REQUIRE(frame.returns[0].amplitude.size() == 4);
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    CHECK(frame.returns[0].amplitude[pixel] == 0);
    CHECK(frame.coverage[pixel] == 0);
    CHECK(frame.triangle_id[pixel] == no_id);
    CHECK(frame.object_id[pixel] == no_id);
    for (const auto *channel :
         {&frame.returns[0].phase_rad, &frame.returns[0].distance_m, &frame.range_m, &frame.z_m})
      CHECK(std::isnan((*channel)[pixel]));
  }
}
