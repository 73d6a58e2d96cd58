// The rounding of a direction's angles, counted in engine/light/rounding_units.h, against what floats make of
// the operations of shaders/light/radiation_laws.glsl.
#include "engine/light/rounding_units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

using namespace pmdsim;

namespace {

constexpr double float_u = 0x1p-24;

// Twice the arctangent of its half, within 45 degrees.
float half_plane_angle(float x, float y, float length) {
  const float larger = std::max(std::abs(x), y), smaller = std::min(std::abs(x), y);
  const float t = smaller / (length + larger);
  const auto pi = std::numbers::pi_v<float>;
  float angle = 2.0f * std::atan(t);
  angle = y > std::abs(x) ? pi / 2.0f - angle : angle;
  return x < 0.0f ? pi - angle : angle;
}

struct Direction {
  glm::dvec3 from_reference_m, source_m, axis, across; // all but the first are of a source
};

struct AxisAngles {
  double theta_rad, phi_rad;
};

AxisAngles exact(const Direction &of) {
  const glm::dvec3 way = of.from_reference_m - of.source_m, around = glm::cross(of.axis, way);
  return {std::atan2(glm::length(around), glm::dot(of.axis, way)),
          std::atan2(-glm::dot(of.across, around), glm::dot(of.across, way))};
}

AxisAngles in_floats(const Direction &of) {
  const glm::vec3 point(of.from_reference_m), source(of.source_m), axis(of.axis), across(of.across);
  const glm::vec3 way = point - source, around = glm::cross(axis, way);
  const float off_axis = std::sqrt(glm::dot(around, around));
  const float along = glm::dot(axis, point) - static_cast<float>(glm::dot(of.axis, of.source_m));
  const float r =
      std::sqrt(glm::dot(point, point) - 2.0f * glm::dot(point, source) + glm::dot(source, source));
  const float y = -glm::dot(across, around);
  const float phi = half_plane_angle(glm::dot(across, way), std::abs(y), off_axis);
  return {half_plane_angle(along, off_axis, r), y < 0.0f ? -phi : phi};
}

} // namespace

TEST_CASE("angles to an axis and about it are off by no more than is counted") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto unit = [&] {
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  };
  double largest_theta = 0.0, largest_phi = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const double t = 0.5 * part(random), range_m = std::exp2(6.0 * part(random) - 3.0);
    const glm::dvec3 axis = unit(), beside = glm::normalize(glm::cross(axis, unit()));
    // Many directions are near the axis, before or behind.
    const double wide = std::exp2(-10.0 * part(random));
    const glm::dvec3 towards = glm::normalize((i % 2 == 0 ? axis : -axis) + wide * unit());
    const Direction direction{range_m * towards, t * range_m * unit(), axis, beside};
    const AxisAngles truth = exact(direction), found = in_floats(direction);
    const double phi_rad = std::remainder(found.phi_rad - truth.phi_rad, 2.0 * std::numbers::pi);
    largest_theta = std::max(largest_theta, std::abs(found.theta_rad - truth.theta_rad) /
                                                (float_u * theta_error_u(t, truth.theta_rad)));
    largest_phi =
        std::max(largest_phi, std::abs(phi_rad) * std::sin(truth.theta_rad) / (float_u * phi_error_u(t)));
  }
  WARN("of what is counted, theta is off by " << largest_theta << ", phi by " << largest_phi);
  CHECK(largest_theta <= 1.0);
  CHECK(largest_theta > 0.05); // else too much is counted
  CHECK(largest_phi <= 1.0);
  CHECK(largest_phi > 0.05);
}

TEST_CASE("what an angle may be off by never falls with the angle, nor with the group's radius") {
  double before = 0.0;
  for (double theta_rad = 0.0; theta_rad < std::numbers::pi; theta_rad += 0.01) {
    CHECK(theta_error_u(0.1, theta_rad) >= before);
    CHECK(theta_error_u(0.2, theta_rad) > theta_error_u(0.1, theta_rad));
    before = theta_error_u(0.1, theta_rad);
  }
}
