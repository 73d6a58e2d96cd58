// Pixels that stand where OpenCV's formulas put a chosen ray measure along that ray.

#include "tests/comparison/planes.h"
#include "tests/support/opencv_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Around the point at 2 m that the ray meets, and slanted, so that one micrometre beside is one micrometre
// more or less.
Square square_across(const glm::dvec3 &ray) {
  const glm::dvec3 beside = glm::normalize(glm::cross(ray, glm::dvec3(0.3, 0.5, -0.8)));
  return {2.0 * glm::normalize(ray), glm::normalize(ray) + beside, 0.1};
}

// The chip moved so that the pixel that else lies at `place_m` lies under the slopes.
Sensor with_pixel_at(Sensor sensor, const glm::dvec3 &place_m, const glm::dvec2 &slopes) {
  sensor.chip.translation_m = {slopes * place_m.z - glm::dvec2(place_m), 0};
  return sensor;
}

Sensor single_pixel_sensor() {
  Sensor sensor;
  sensor.resolution = {1, 1};
  sensor.pixel_pitch_m = glm::dvec2(1e-5);
  sensor.focal_length_m = 0.012;
  return sensor;
}

template <typename Model>
void check_ray(Engine engine, const std::string &name, const Model &distortion, const glm::dvec3 &ray) {
  Sensor sensor = with_pixel_at(single_pixel_sensor(), {0, 0, 0.012}, opencv_distorted(ray, distortion));
  sensor.distortion = distortion;
  const Square square = square_across(ray);
  const Measurement measured = measure_monostatic(engine, scene_of(square), sensor);
  check_point(engine, name, square.centre_m, sensor, measured, 0);
}

} // namespace

TEST_CASE("a pixel under Brown-Conrady distortion measures along its ray") {
  const Engine engine = both_engines();
  const auto [name, distortion] =
      GENERATE(table<std::string, BrownConrady>({{"barrel -0.3", {-0.3, 0, 0, 0, 0}},
                                                 {"pincushion 0.2", {0.2, 0, 0, 0, 0}},
                                                 {"all five", {-0.25, 0.08, 1e-3, -2e-3, -0.01}}}));
  for (const glm::dvec2 slopes : {glm::dvec2(0), {0.3, -0.2}, {-0.7, 0.4}, {0.1, 0.9}})
    check_ray(engine, fmt::format("{}, slopes {:+} {:+}", name, slopes.x, slopes.y), distortion,
              glm::dvec3(slopes, 1));
}

TEST_CASE("the ray of a pixel under Brown-Conrady distortion, in numbers") {
  const Engine engine = both_engines();
  Sensor sensor = single_pixel_sensor();
  sensor.distortion = BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01};
  // By hand for the slopes (0.3, -0.2): r^2 = 0.13, 1 + k1 r^2 + k2 r^4 + k3 r^6 = 0.96883003, x y = -0.06.
  const glm::dvec2 slopes(0.290649009 - 0.00012 - 0.00062, -0.193766006 + 0.00021 + 0.00024);
  sensor.chip.translation_m = {0.012 * slopes, 0};
  const Square square{{0, 0, 2}, {0, 1, 1}};
  const Measurement measured = measure_monostatic(engine, scene_of(square), sensor);
  // z = 2 - y = 2 + 0.2 z.
  check_point(engine, "all five, by hand", {0.75, -0.5, 2.5}, sensor, measured, 0);
}

TEST_CASE("a fisheye's pixel measures along its ray, also behind the lens") {
  const Engine engine = both_engines();
  const auto [name, distortion] = GENERATE(table<std::string, Fisheye>(
      {{"equidistant", {}}, {"four coefficients", {-0.03, 0.01, -0.004, 0.0005}}}));
  for (const double degrees : {0.0, 10.0, 60.0, 85.0, 95.0, 130.0}) {
    const double angle_rad = degrees * degree;
    check_ray(engine, fmt::format("fisheye, {}, {} degrees", name, degrees), distortion,
              {0.6 * std::sin(angle_rad), -0.8 * std::sin(angle_rad), std::cos(angle_rad)});
  }
}

TEST_CASE("a fisheye's pixel sees the wall behind the lens") {
  const Engine engine = both_engines();
  Sensor sensor = single_pixel_sensor();
  sensor.distortion = Fisheye{};
  // At 120 degrees, to the right: a wall 1 m behind the lens is 2 m away.
  sensor.chip.translation_m.x = 0.012 * 2 * std::numbers::pi / 3;
  const Measurement measured = measure_monostatic(engine, scene_of({{0, 0, -1}, {0, 0, 1}}), sensor);
  check_point(engine, "fisheye, 120 degrees, wall behind", {std::sqrt(3), 0, -1}, sensor, measured, 0);
}

TEST_CASE("a pixel of a tilted chip under distortion measures along its ray") {
  const Engine engine = both_engines();
  Sensor sensor;
  sensor.resolution = {5, 4};
  sensor.pixel_pitch_m = glm::dvec2(1e-3);
  sensor.focal_length_m = 0.012;
  sensor.chip.rotation_rad.x = std::atan2(3, 4);
  // Pixel (4, 3) is at (2, 1.5) mm on the chip, (2, 1.2, 12.9) mm in front of the lens.
  const glm::dvec3 place_m(2e-3, 1.2e-3, 12.9e-3);
  const auto check = [&](const std::string &name, const auto &distortion, const glm::dvec3 &ray) {
    sensor = with_pixel_at(sensor, place_m, opencv_distorted(ray, distortion));
    sensor.distortion = distortion;
    const Square square = square_across(ray);
    check_point(engine, name, square.centre_m, sensor, measure_monostatic(engine, scene_of(square), sensor),
                19);
  };
  check("tilted, barrel", BrownConrady{-0.3, 0, 1e-3, -2e-3, 0}, {0.25, 0.35, 1});
  check("tilted, fisheye", Fisheye{-0.03, 0.01, -0.004, 0.0005}, {-1.4, 0.9, 0.5});
}
