#include "tests/support/random_cameras.h"
#include "tests/support/units.h"

#include <cmath>
#include <numbers>

namespace pmdsim::test {

namespace {

constexpr glm::dvec2 chip_m{24e-3, 16e-3};

// Coefficients are drawn by what they do at the image's corner, a slope of `radius`.
Distortion random_brown(Random &random, double radius) {
  const double strength = std::exp(random.uniform(std::log(0.01), 0.0));
  const auto relative = [&](double power) {
    return strength * random.uniform(-0.4, 0.4) / std::pow(radius, power);
  };
  const double k1 = relative(2), k2 = relative(4), k3 = relative(6);
  const double p1 = 0.2 * relative(1), p2 = 0.2 * relative(1);
  return BrownConrady{k1, k2, p1, p2, k3};
}

Distortion random_fisheye(Random &random, double largest_angle_rad) {
  const double strength = std::exp(random.uniform(std::log(0.01), 0.0));
  const auto relative = [&](double power) {
    return strength * random.uniform(-0.15, 0.15) / std::pow(largest_angle_rad, power);
  };
  const double k1 = relative(2), k2 = relative(4), k3 = relative(6), k4 = relative(8);
  return Fisheye{k1, k2, k3, k4};
}

Chip random_chip(Random &random) {
  const double tilt_rad = random.uniform(0, 12) * degree,
               towards_rad = random.uniform(0, 2 * std::numbers::pi);
  const double turn_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  return {{tilt_rad * std::cos(towards_rad), tilt_rad * std::sin(towards_rad), turn_rad},
          random.in_box(glm::dvec3(-3e-3, -3e-3, -1e-3), glm::dvec3(3e-3, 3e-3, 1e-3))};
}

} // namespace

Sensor random_camera(Random &random, const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.pixel_pitch_m = chip_m / glm::dvec2(resolution);
  sensor.chip = random_chip(random);
  if (random.flip())
    sensor.fill_factor = {random.uniform(0.3, 1), random.uniform(0.3, 1)};
  sensor.vignetting = random.flip() ? Vignetting::cos4 : Vignetting::none;
  const double half_diagonal_m = 0.5 * glm::length(chip_m), kind = random.uniform(0, 3);
  if (kind < 2) {
    sensor.focal_length_m = random.uniform(0.02, 0.04);
    if (kind < 1)
      sensor.distortion = random_brown(random, half_diagonal_m / sensor.focal_length_m);
  } else {
    const double half_view_rad = random.uniform(30, 120) * degree;
    sensor.focal_length_m = half_diagonal_m / half_view_rad;
    sensor.distortion = random_fisheye(random, half_view_rad);
  }
  return sensor;
}

} // namespace pmdsim::test
