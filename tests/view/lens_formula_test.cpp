// Where the rays of all pixels of a chip come from: the simulator's lens and the reference's against OpenCV's
// published formula, and the simulator's against its own inverse.

#include "engine/lens/lens.h"
#include "engine/reference/view/lens_model.h"
#include "tests/support/opencv_formula.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <optional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double largest_error_pixels = 1e-6;

// The questions about a sensor that both lens models can answer.
class SimulatorsLens {
public:
  explicit SimulatorsLens(const Sensor &sensor) : lens_(sensor) {}
  static constexpr const char *name = "simulator";
  std::optional<glm::dvec3> ray(const glm::uvec2 &pixel) const {
    return lens_.ray(lens_.on_chip_m(glm::dvec2(pixel) + 0.5));
  }
  double way_back_error(const glm::dvec3 &ray, const glm::dvec2 &pixel) const {
    const auto chip_m = lens_.chip_m(ray);
    return chip_m ? glm::distance(lens_.pixel(*chip_m), pixel) : std::numeric_limits<double>::infinity();
  }

private:
  Lens lens_;
};

class ReferencesLens {
public:
  explicit ReferencesLens(const Sensor &sensor) : lens_(sensor) {}
  static constexpr const char *name = "reference";
  std::optional<glm::dvec3> ray(const glm::uvec2 &pixel) const { return lens_.sample_ray(pixel); }
  double way_back_error(const glm::dvec3 &, const glm::dvec2 &) const { return 0; } // it knows no way back

private:
  reference::LensModel lens_;
};

struct Errors {
  double of_formula_pixels = 0, of_way_back_pixels = 0;
  double largest_angle_rad = 0;
  std::size_t without_ray = 0;
};

// The largest errors over every pixel's centre: its ray taken to a pixel by the formula, and by the lens's
// own way back.
template <typename SomeLens, typename Model>
Errors errors_of(const Sensor &sensor, const Model &distortion) {
  const SomeLens lens(sensor);
  Errors errors;
  for (glm::uvec2 pixel(0); pixel.y < sensor.resolution.y; ++pixel.y)
    for (pixel.x = 0; pixel.x < sensor.resolution.x; ++pixel.x) {
      const auto ray = lens.ray(pixel);
      if (!ray) {
        ++errors.without_ray;
        continue;
      }
      const glm::dvec2 centre = glm::dvec2(pixel) + 0.5;
      errors.of_formula_pixels =
          std::max(errors.of_formula_pixels, glm::distance(opencv_pixel(*ray, distortion, sensor), centre));
      errors.of_way_back_pixels = std::max(errors.of_way_back_pixels, lens.way_back_error(*ray, centre));
      errors.largest_angle_rad =
          std::max(errors.largest_angle_rad, std::atan2(std::hypot(ray->x, ray->y), ray->z));
    }
  return errors;
}

template <typename SomeLens, typename Model>
void check_whole_chip(const std::string &name, const Sensor &sensor, const Model &distortion) {
  const Errors errors = errors_of<SomeLens>(sensor, distortion);
  fmt::print("{:<40}{:<12}{:>14.1f}{:>16.1e}{:>16.1e}\n", name, SomeLens::name,
             errors.largest_angle_rad * 180 / std::numbers::pi, errors.of_formula_pixels,
             errors.of_way_back_pixels);
  INFO(name << " by the " << SomeLens::name);
  CHECK(errors.without_ray == 0);
  CHECK(errors.of_formula_pixels <= largest_error_pixels);
  CHECK(errors.of_way_back_pixels <= largest_error_pixels);
}

// 640 x 480 pixels, whose corners' centres lie as far out as a ray of the given angle.
template <typename Model>
Sensor sensor_to(const Model &distortion, double corner_angle_rad) {
  Sensor sensor;
  sensor.resolution = {640, 480};
  sensor.focal_length_m = 0.008;
  const double slope =
      glm::length(opencv_distorted({std::sin(corner_angle_rad), 0, std::cos(corner_angle_rad)}, distortion));
  sensor.pixel_pitch_m =
      glm::dvec2(slope * sensor.focal_length_m / (0.5 * std::hypot(639, 479))) * glm::dvec2(0.99, 1.0);
  sensor.distortion = distortion;
  return sensor;
}

template <typename Model>
void check_lenses(const std::string &name, const Model &distortion, double corner_degrees) {
  const Sensor sensor = sensor_to(distortion, corner_degrees * std::numbers::pi / 180);
  check_whole_chip<SimulatorsLens>(name, sensor, distortion);
  check_whole_chip<ReferencesLens>(name, sensor, distortion);
}

} // namespace

TEST_CASE("pixel centres against OpenCV's formula, and there and back, over the whole chip") {
  fmt::print("{:<40}{:<12}{:>14}{:>16}{:>16}\n", "distortion, 640 x 480 pixels", "lens of", "to (degrees)",
             "OpenCV (pixel)", "back (pixel)");
  check_lenses("none", BrownConrady{}, 40);
  check_lenses("barrel -0.3", BrownConrady{-0.3, 0, 0, 0, 0}, 40);
  check_lenses("pincushion 0.2", BrownConrady{0.2, 0, 0, 0, 0}, 60);
  check_lenses("all five of Brown and Conrady", BrownConrady{-0.28, 0.09, 1e-3, -2e-3, -0.013}, 45);
  check_lenses("tangential only", BrownConrady{0, 0, 0.01, -0.02, 0}, 40);
  check_lenses("fisheye, equidistant, 170 degrees", Fisheye{}, 85);
  check_lenses("fisheye, four, 170 degrees", Fisheye{-0.03, 0.01, -0.004, 0.0005}, 85);
  check_lenses("fisheye, equidistant, 340 degrees", Fisheye{}, 170);
  check_lenses("fisheye, four, 340 degrees", Fisheye{-0.02, 0.004, -4e-4, 2e-5}, 170);
}
