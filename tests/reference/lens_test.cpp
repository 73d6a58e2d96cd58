// The lens model against OpenCV's published formulas, of which it is the inverse, and these by hand.

#include "engine/reference/reference.h"
#include "engine/reference/view/lens_model.h"
#include "tests/reference/monostatic_frame.h"
#include "tests/support/opencv_formula.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <limits>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using reference::LensModel;

namespace {

constexpr double largest_pixel_error = 1e-10;

// Its chip spans the given slopes, edge to edge about the centre.
Sensor sensor_with(const Distortion &distortion, const glm::dvec2 &slopes, const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.focal_length_m = 0.012;
  sensor.pixel_pitch_m = slopes * sensor.focal_length_m / glm::dvec2(resolution);
  sensor.distortion = distortion;
  return sensor;
}

// A row of three pixels, of which the right one looks through the place with the slopes (slope, 0).
Sensor row_of_three(const Distortion &distortion, double slope) {
  return sensor_with(distortion, {3 * slope, slope}, {3, 1});
}

// How far from a sample its ray arrives on the chip, in pixels; the largest over the chip.
template <typename Model>
double largest_way_and_back_error(const Sensor &sensor, const Model &distortion) {
  const LensModel lens(sensor);
  double largest = 0.0;
  for (glm::uvec2 sample(0); sample.y < sensor.resolution.y; ++sample.y)
    for (sample.x = 0; sample.x < sensor.resolution.x; ++sample.x) {
      const auto ray = lens.sample_ray(sample);
      if (!ray)
        return std::numeric_limits<double>::infinity();
      const glm::dvec2 centre = glm::dvec2(sample) + 0.5;
      largest = std::max(largest, glm::distance(opencv_pixel(*ray, distortion, sensor), centre));
    }
  return largest;
}

} // namespace

TEST_CASE("Brown-Conrady's formula by hand") {
  // By hand for (0.3, -0.2): r^2 = 0.13, 1 + k1 r^2 + k2 r^4 + k3 r^6 = 0.96883003, x y = -0.06.
  const auto slopes = opencv_distorted({0.6, -0.4, 2}, BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01});
  CHECK(slopes.x == Approx(0.290649009 - 0.00012 - 0.00062).epsilon(1e-14));
  CHECK(slopes.y == Approx(-0.193766006 + 0.00021 + 0.00024).epsilon(1e-14));
}

TEST_CASE("the fisheye's formula by hand") {
  // By hand for 45 degrees: theta = 0.785398163, theta_d = 0.822135134, in the direction (0.6, 0.8).
  const auto slopes = opencv_distorted({1.2, 1.6, 2}, Fisheye{0.1, -0.05, 0.02, -0.004});
  CHECK(slopes.x == Approx(0.6 * 0.8221351339119517).epsilon(1e-14));
  CHECK(slopes.y == Approx(0.8 * 0.8221351339119517).epsilon(1e-14));
}

TEST_CASE("a distorted sample's ray leads back to the sample") {
  const auto distortion =
      GENERATE(BrownConrady{-0.28, 0.09, 5e-4, -3e-4, -0.013}, BrownConrady{0.2, 0.05, -1e-3, 2e-3, 0.01},
               BrownConrady{-0.28, 0.09, 0, 0, -0.013}, BrownConrady{0, 0, 0.02, -0.03, 0},
               BrownConrady{0, 0, 0, 0, 0});
  CHECK(largest_way_and_back_error(sensor_with(distortion, {1.2, 0.9}, {81, 61}), distortion) <
        largest_pixel_error);
}

TEST_CASE("a fisheye's ray leads back to the sample, to 170 degrees from the axis") {
  const auto distortion =
      GENERATE(Fisheye{}, Fisheye{0.03, -0.004, 1e-3, -4e-5}, Fisheye{-0.02, 0.004, -4e-4, 2e-5});
  Sensor sensor = sensor_with(distortion, {1, 1}, {81, 61});
  const double angle_rad = 170 * std::numbers::pi / 180;
  const double corner_slope = opencv_distorted({std::sin(angle_rad), 0, std::cos(angle_rad)}, distortion).x;
  sensor.pixel_pitch_m = glm::dvec2(corner_slope * sensor.focal_length_m / std::hypot(40, 30));
  CHECK(largest_way_and_back_error(sensor, distortion) < largest_pixel_error);
  CHECK(LensModel(sensor).sample_ray({80, 60})->z == Approx(std::cos(angle_rad)).epsilon(1e-13));
}

TEST_CASE("a distorted sample's ray is the one on the branch from the optical axis") {
  Random random(31);
  // Both fold back before the image ends, the second rises again behind.
  const auto [distortion, fold] = GENERATE(table<BrownConrady, double>(
      {{{-0.3, 0, 1e-3, -5e-4, 0}, std::sqrt(1 / 0.9)}, {{-0.8, 0.2, 1e-4, 1e-4, 0}, 0.7326}}));
  for (int i = 0; i < 1000; ++i) {
    const double radius = fold * random.uniform(0, 0.95), angle_rad = random.uniform(0, 6.28);
    const glm::dvec3 ray =
        glm::normalize(glm::dvec3(radius * std::cos(angle_rad), radius * std::sin(angle_rad), 1));
    Sensor sensor = sensor_with(distortion, {1, 1}, {1, 1});
    sensor.chip.translation_m = {opencv_distorted(ray, distortion) * sensor.focal_length_m, 0};
    const auto found = LensModel(sensor).sample_ray({0, 0});
    REQUIRE(found);
    REQUIRE(glm::length(*found - ray) < 1e-13);
  }
}

TEST_CASE("where a distortion hardly rises its inverse does not leave the branch") {
  const auto [distortion, slopes] = GENERATE(table<BrownConrady, glm::dvec2>(
      {{{-0.873218, 0.407103, -0.0262596, -0.0182183, -0.0595987}, {-1.48342, 0.130757}},
       {{-0.851675, 0.388585, 0.0150216, 0.0245336, -0.0599573}, {1.55422, -0.558215}},
       {{-0.67845, 0.351544, -0.0263629, -0.0261684, -0.0558805}, {0.784705, 1.45698}}}));
  const glm::dvec3 ray = glm::normalize(glm::dvec3(slopes, 1));
  Sensor sensor = sensor_with(distortion, {1, 1}, {1, 1});
  sensor.chip.translation_m = {opencv_distorted(ray, distortion) * sensor.focal_length_m, 0};
  const auto found = LensModel(sensor).sample_ray({0, 0});
  REQUIRE(found);
  CHECK(glm::length(*found - ray) < 1e-13);
}

TEST_CASE("beyond the fold of its distortion a sample sees nothing") {
  const double p1 = GENERATE(0.0, 1e-4);
  const auto [k1, k2, last_slope] =
      GENERATE(table<double, double, double>({{-0.3, 0, 0.70273}, {-0.8, 0.2, 0.46023}}));
  const double beside = GENERATE(-0.002, 0.002, 0.04, 1.0, 1e6);
  const Sensor sensor = row_of_three(BrownConrady{k1, k2, p1, 0, 0}, last_slope + beside);
  const auto frame = monostatic_frame(wall_at(2), sensor);
  CHECK(frame.coverage[1] == 1);
  CHECK(frame.coverage[2] == (beside < 0 ? 1 : 0));
  CHECK(std::isnan(frame.returns[0].phase_rad[2]) == beside > 0);
}

TEST_CASE("a fisheye has no rays beyond the fold of its angle, nor beyond 180 degrees") {
  const auto [k1, last_slope] = GENERATE(table<double, double>({{-0.1, 1.21716}, {0, std::numbers::pi}}));
  const double beside = GENERATE(-0.002, 0.002, 10.0);
  const Sensor sensor = row_of_three(Fisheye{k1, 0, 0, 0}, last_slope + beside);
  CHECK(LensModel(sensor).sample_ray({2, 0}).has_value() == beside < 0);
}

TEST_CASE("a ray beyond 90 degrees sees what lies behind the lens") {
  const double angle_rad = 2;
  Sensor sensor = row_of_three(Fisheye{}, angle_rad);
  SceneBuilder builder;
  builder.add_wall({-1, {1.0, true}});
  const auto frame = monostatic_frame(builder.scene(), sensor);
  CHECK(frame.coverage == std::vector<double>{1, 0, 1});
  for (const std::size_t side : {0u, 2u}) {
    CHECK(frame.range_m[side] == Approx(-1 / std::cos(angle_rad)).epsilon(1e-14));
    CHECK(frame.z_m[side] == Approx(-1).epsilon(1e-14));
    CHECK(frame.returns[0].distance_m[side] == Approx(frame.range_m[side]).epsilon(1e-13));
  }
  sensor.vignetting = Vignetting::cos4;
  CHECK(monostatic_frame(builder.scene(), sensor).returns[0].amplitude[2] == 0);
}
