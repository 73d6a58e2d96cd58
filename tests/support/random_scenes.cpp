#include "tests/support/random_scenes.h"

#include "tests/support/scenes.h"

#include <cmath>
#include <numbers>

namespace pmdsim::test {

double Random::uniform(double lower, double upper) {
  constexpr double count = 4294967296.0;
  return lower + (upper - lower) * (static_cast<double>(engine_()) + 0.5) / count;
}

double Random::log_uniform(double lower, double upper) {
  return lower * std::pow(upper / lower, uniform(0, 1));
}

glm::dvec3 Random::in_box(const glm::dvec3 &lower, const glm::dvec3 &upper) {
  const double x = uniform(lower.x, upper.x);
  const double y = uniform(lower.y, upper.y);
  const double z = uniform(lower.z, upper.z);
  return {x, y, z};
}

glm::dvec3 Random::unit_vector() {
  const double z = uniform(-1, 1);
  const double longitude_rad = uniform(0, 2 * std::numbers::pi);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(longitude_rad), radius * std::sin(longitude_rad), z};
}

Pose Random::pose(double reach_m) {
  const glm::dvec3 z = unit_vector();
  const glm::dvec3 x = glm::normalize(glm::cross(unit_vector(), z));
  return {glm::dmat3(x, glm::cross(z, x), z), in_box(glm::dvec3(-reach_m), glm::dvec3(reach_m))};
}

Scene random_triangles(Random &random, std::size_t count, const Pose &world_from_camera) {
  SceneBuilder builder(world_from_camera);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 centre_m = random.in_box({-0.7, -0.7, 1.3}, {0.7, 0.7, 2.5});
    const double size_m = random.uniform(0.1, 0.5);
    std::array<glm::dvec3, 3> corners_m;
    for (glm::dvec3 &corner_m : corners_m)
      corner_m = centre_m + size_m * random.unit_vector();
    const double reflectivity = random.uniform(0.1, 1.0);
    builder.add_triangle(corners_m[0], corners_m[1], corners_m[2], {reflectivity, random.flip()});
  }
  return builder.scene();
}

Illuminator random_illuminator(Random &random, std::size_t diodes, const Pose &world_from_illuminator) {
  Illuminator illuminator{"random", world_from_illuminator, {}};
  for (std::size_t i = 0; i < diodes; ++i) {
    Diode diode;
    diode.position_m = random.in_box(glm::dvec3(-0.14), glm::dvec3(0.14));
    const double tilt_rad = random.uniform(0, std::numbers::pi / 3);
    const double roll_rad = random.uniform(0, 2 * std::numbers::pi);
    diode.axis = {std::sin(tilt_rad) * std::cos(roll_rad), std::sin(tilt_rad) * std::sin(roll_rad),
                  std::cos(tilt_rad)};
    diode.intensity_w_sr = random.uniform(0.1, 2.0);
    if (random.flip())
      diode.pattern = {Pattern::Kind::cosine,
                       random.flip() ? std::floor(random.uniform(0, 4)) : random.uniform(0, 30)};
    illuminator.diodes.push_back(diode);
  }
  return illuminator;
}

} // namespace pmdsim::test
