// Where the chip stands: eq. 1's rotations and translation.

#include "engine/reference/reference.h"
#include "engine/reference/view/lens_model.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double focal_length_m = 0.1, pitch_m = 0.05;

Sensor three_by_three(const Chip &chip) {
  Sensor sensor;
  sensor.resolution = {3, 3};
  sensor.focal_length_m = focal_length_m;
  sensor.pixel_pitch_m = glm::dvec2(pitch_m);
  sensor.chip = chip;
  return sensor;
}

// The ray of the pixel whose centre lies at pitch_m * (x, y) on the chip.
glm::dvec3 ray_of(const Sensor &sensor, int x, int y) {
  return *reference::LensModel(sensor).sample_ray(glm::uvec2(x + 1, y + 1));
}

void check_parallel(const glm::dvec3 &ray, const glm::dvec3 &expected) {
  CHECK(glm::length(ray - glm::normalize(expected)) < 1e-15);
}

} // namespace

TEST_CASE("a chip in its nominal place changes no bit") {
  Sensor sensor;
  sensor.resolution = {7, 5};
  sensor.chip = {glm::dvec3(0), glm::dvec3(0)};
  for (glm::uvec2 pixel(0); pixel.y < 5; ++pixel.y)
    for (pixel.x = 0; pixel.x < 7; ++pixel.x) {
      const glm::dvec2 centre_m = (glm::dvec2(pixel) + 0.5 - 0.5 * glm::dvec2(7, 5)) * sensor.pixel_pitch_m;
      CHECK(reference::LensModel(sensor).sample_ray(pixel) ==
            glm::normalize(glm::dvec3(centre_m, sensor.focal_length_m)));
    }
}

TEST_CASE("alpha tilts the chip about x, beta about y, gamma turns it about z") {
  const double angle_rad = GENERATE(0.4, -0.2), c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double d = focal_length_m, p = pitch_m;
  const Sensor about_x = three_by_three({{angle_rad, 0, 0}, {}});
  check_parallel(ray_of(about_x, 1, 0), {p, 0, d});
  check_parallel(ray_of(about_x, 0, 1), {0, p * c, d + p * s});
  check_parallel(ray_of(about_x, -1, -1), {-p, -p * c, d - p * s});
  const Sensor about_y = three_by_three({{0, angle_rad, 0}, {}});
  check_parallel(ray_of(about_y, 0, 1), {0, p, d});
  check_parallel(ray_of(about_y, 1, 0), {p * c, 0, d - p * s});
  const Sensor about_z = three_by_three({{0, 0, angle_rad}, {}});
  check_parallel(ray_of(about_z, 1, 0), {p * c, p * s, d});
  check_parallel(ray_of(about_z, 0, 1), {-p * s, p * c, d});
}

TEST_CASE("gamma turns first, then beta, then alpha") {
  const double quarter_rad = std::numbers::pi / 2, d = focal_length_m, p = pitch_m;
  const Sensor alpha_gamma = three_by_three({{quarter_rad, 0, quarter_rad}, {}});
  check_parallel(ray_of(alpha_gamma, 1, 0), {0, 0, d + p});
  check_parallel(ray_of(alpha_gamma, 0, 1), {-p, 0, d});
  const Sensor alpha_beta = three_by_three({{quarter_rad, quarter_rad, 0}, {}});
  check_parallel(ray_of(alpha_beta, 1, 0), {0, p, d});
  const Sensor beta_gamma = three_by_three({{0, quarter_rad, quarter_rad}, {}});
  check_parallel(ray_of(beta_gamma, 1, 0), {0, p, d});
}

TEST_CASE("a chip beside the axis and farther from the lens looks aside and narrower") {
  const double d = focal_length_m, p = pitch_m;
  const Sensor sensor = three_by_three({{}, {0.03, -0.02, 0.04}});
  check_parallel(ray_of(sensor, 0, 0), {0.03, -0.02, d + 0.04});
  check_parallel(ray_of(sensor, 1, -1), {0.03 + p, -0.02 - p, d + 0.04});
}

TEST_CASE("a tilted chip measures along its own rays") {
  const double alpha_rad = 0.3;
  const Sensor sensor = three_by_three({{alpha_rad, 0, 0}, {0.01, 0, 0}});
  const auto frame = reference::simulate(
      wall_at(2), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  // The bottom centre pixel.
  const double depth_m = focal_length_m + pitch_m * std::sin(alpha_rad);
  const double range_m = 2 * std::hypot(1, 0.01 / depth_m, pitch_m * std::cos(alpha_rad) / depth_m);
  CHECK(frame.range_m[7] == Approx(range_m).epsilon(1e-14));
  CHECK(frame.returns[0].distance_m[7] == Approx(range_m).epsilon(1e-13));
  CHECK(frame.z_m[7] == Approx(2).epsilon(1e-14));
}

TEST_CASE("the part of a chip that reaches behind the lens sees nothing") {
  SceneBuilder builder;
  builder.add_wall({2});
  builder.add_wall({-2, {1.0, true}});
  Sensor sensor = three_by_three({{std::numbers::pi / 2, 0, 0}, {0, 0, 0.01 - focal_length_m}});
  sensor.distortion = GENERATE(as<Distortion>{}, std::monostate{}, BrownConrady{}, Fisheye{});
  const auto frame = reference::simulate(
      builder.scene(), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  CHECK(frame.coverage[1] == 0); // top: pitch_m behind the lens but for 0.01 m
  CHECK(frame.coverage[4] == 1);
  CHECK(frame.coverage[7] == 1);
}
