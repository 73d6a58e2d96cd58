#include "tests/comparison/planes.h"

#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pmdsim::test {

Scene scene_of(const Square &square) {
  const glm::dvec3 normal = glm::normalize(square.normal);
  const glm::dvec3 beside = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = square.half_side_m * glm::normalize(glm::cross(normal, beside));
  const glm::dvec3 v = glm::cross(normal, u);
  const glm::dvec3 &c = square.centre_m;
  SceneBuilder builder;
  builder.add_mesh({c - u - v, c + u - v, c + u + v, c - u + v}, {{0, 1, 2}, {0, 2, 3}}, {1.0, true});
  return builder.scene();
}

glm::dvec3 meeting_point_m(const Square &square, const glm::dvec3 &place) {
  return place * (glm::dot(square.normal, square.centre_m) / glm::dot(square.normal, place));
}

void check_point(Engine engine, const std::string &name, const glm::dvec3 &true_m, const Sensor &sensor,
                 const Measurement &measured, std::size_t pixel) {
  REQUIRE(measured.coverage[pixel] == 1);
  const double range_m = glm::length(true_m);
  check_distance(engine, name, range_m, sensor, measured.returns[0].distance_m[pixel]);
  check_within(engine, name + ", range", range_m, measured.range_m[pixel], 2e-6);
  check_within(engine, name + ", z", true_m.z, measured.z_m[pixel], 2e-6);
}

} // namespace pmdsim::test
