// Distances that the reference must give, in closed form: d = (r_nm + r_n) / 2 for one diode.

#include "engine/reference/reference.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

double monostatic_distance_m(const Scene &scene, const Sensor &sensor) {
  return reference::simulate(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                             Backscatter::constant)
      .returns[0]
      .distance_m[0];
}

} // namespace

TEST_CASE("a diode beside the lens reads half of its longer path") {
  const double z_m = GENERATE(0.5, 1.0, 2.0, 5.0);
  const double baseline_m = 0.05;
  const Sensor sensor = axial_sensor();
  const auto frame = reference::simulate(
      wall_at(z_m), sensor, {diode_beside_lens(sensor, diode_at({baseline_m, 0, 0}))}, Backscatter::lambert);
  CHECK(frame.returns[0].distance_m[0] ==
        Approx((std::hypot(z_m, baseline_m) + z_m) / 2).epsilon(0).margin(1e-12));
  CHECK(frame.range_m[0] == Approx(z_m).epsilon(1e-15));
  CHECK(frame.returns[0].phase_rad[0] ==
        Approx(2 * std::numbers::pi * frame.returns[0].distance_m[0] / sensor.ambiguity_m()).epsilon(1e-14));
}

TEST_CASE("distance wraps at c / (2 f)") {
  const double z_m = GENERATE(15.0, 20.0, 49.0, 1e5);
  Sensor sensor = axial_sensor();
  sensor.modulation_hz = {10e6};
  CHECK(monostatic_distance_m(wall_at(z_m), sensor) ==
        Approx(std::fmod(z_m, sensor.ambiguity_m())).epsilon(0).margin(1e-15 * z_m + 1e-13));
}

TEST_CASE("a pixel off the axis reads the distance along its ray") {
  Sensor sensor;
  sensor.resolution = {3, 3};
  sensor.pixel_pitch_m = {0.05, 0.03};
  sensor.focal_length_m = 0.1;
  const auto frame = reference::simulate(
      wall_at(2), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  const double per_depth = std::sqrt(1 + 0.5 * 0.5 + 0.3 * 0.3);
  for (const std::size_t corner : {0u, 2u, 6u, 8u}) {
    CHECK(frame.returns[0].distance_m[corner] == Approx(2 * per_depth).epsilon(1e-13));
    CHECK(frame.range_m[corner] == Approx(2 * per_depth).epsilon(1e-14));
    CHECK(frame.z_m[corner] == Approx(2).epsilon(1e-14));
  }
}

TEST_CASE("a focus nearer than infinity moves the chip back and narrows the view") {
  Sensor sensor;
  sensor.resolution = {3, 1};
  sensor.pixel_pitch_m = glm::dvec2(0.1);
  sensor.focal_length_m = 0.1;
  sensor.focus_distance_m = 0.2;
  const auto frame = reference::simulate(
      wall_at(2), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  CHECK(frame.range_m[0] == Approx(2 * std::sqrt(1 + 0.5 * 0.5)).epsilon(1e-14));
}

TEST_CASE("a pixel half on a near and half on a far wall mixes their phasors") {
  const double near_m = 1.0, far_m = 1.5;
  const bool equal_weights = GENERATE(true, false);
  const double near_reflectivity = equal_weights ? (near_m * near_m) / (far_m * far_m) : 1.0;
  SceneBuilder builder;
  builder.add_wall({near_m, {near_reflectivity}, {-1, -1}, {0, 1}});
  builder.add_wall({far_m, {}, {-2, -2}, {2, 2}});
  Sensor sensor = axial_sensor();
  sensor.samples = 2;
  const auto frame = reference::simulate(
      builder.scene(), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);

  const double wavenumber = 4 * std::numbers::pi * sensor.modulation_hz[0] / speed_of_light_m_s;
  const auto z = 0.5 * (std::polar(near_reflectivity / (near_m * near_m), wavenumber * near_m) +
                        std::polar(1.0 / (far_m * far_m), wavenumber * far_m));
  CHECK(frame.returns[0].distance_m[0] == Approx(std::arg(z) / wavenumber).epsilon(0).margin(1e-10));
  CHECK(frame.returns[0].distance_m[0] == Approx(equal_weights ? 1.25 : 1.152630).epsilon(0).margin(5e-7));
  CHECK(frame.returns[0].amplitude[0] == Approx(std::abs(z)).epsilon(1e-10));
}

TEST_CASE("phase grows with the path's length from zero") {
  const Sensor sensor = axial_sensor();
  const auto frame =
      reference::simulate(wall_at(sensor.ambiguity_m() / 4), sensor,
                          {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  CHECK(frame.returns[0].phase_rad[0] == Approx(std::numbers::pi / 2).epsilon(1e-13));
  CHECK(frame.returns[0].z[0].imag() > 0);
}

TEST_CASE("a scene far from the world's origin is measured as at the origin") {
  const glm::dvec3 offset_m(1e7, -1e7, 1e7);
  const Pose turned_only{Random(7).pose(1).rotation, glm::dvec3(0)};
  const Pose turned_far{turned_only.rotation, offset_m};
  const auto measure = [](const Pose &world_from_camera) {
    SceneBuilder builder(world_from_camera);
    builder.add_triangle({-3, -4, 1.5}, {-3, 3, 2.5}, {4, 3, 2}, {});
    Sensor sensor = axial_sensor({5, 5});
    sensor.pixel_pitch_m = glm::dvec2(0.02);
    sensor.world_from_camera = world_from_camera;
    return reference::simulate(builder.scene(), sensor,
                               {diode_beside_lens(sensor, diode_at({0.1, 0.02, -0.03}))},
                               Backscatter::lambert);
  };
  const auto near = measure(turned_only);
  const auto far = measure(turned_far);
  REQUIRE(near.coverage[12] == 1);
  const double spacing_at_offset_m = 1e7 * std::numeric_limits<double>::epsilon();
  for (std::size_t pixel = 0; pixel < near.returns[0].z.size(); ++pixel)
    CHECK(far.returns[0].distance_m[pixel] ==
          Approx(near.returns[0].distance_m[pixel]).epsilon(0).margin(10 * spacing_at_offset_m));
}
