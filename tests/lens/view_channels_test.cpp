// Rays and normals of pixels against what follows by hand.

#include "engine/lens/view_channels.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

void check_vector(const glm::dvec3 &found, const glm::dvec3 &expected) {
  INFO(found.x << " " << found.y << " " << found.z);
  CHECK(glm::distance(found, expected) <= 1e-14);
}

// From the camera's frame to the world's.
Pose any_pose() {
  const double c = std::cos(0.7), s = std::sin(0.7);
  return {glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c) * node_from_camera().rotation, {0.3, -2.0, 5.0}};
}

} // namespace

TEST_CASE("a pinhole's rays go through the pixels' centres") {
  Sensor sensor;
  sensor.resolution = {4, 3};
  sensor.pixel_pitch_m = {1e-3, 2e-3};
  sensor.focal_length_m = 5e-3;
  const std::vector<glm::dvec3> rays = rays_of(sensor);
  REQUIRE(rays.size() == 12);
  check_vector(rays[0], glm::normalize(glm::dvec3(-1.5e-3, -2e-3, 5e-3)));
  check_vector(rays[2 * 4 + 3], glm::normalize(glm::dvec3(1.5e-3, 2e-3, 5e-3)));
  Measurement frame;
  add_rays(sensor, true, frame);
  CHECK(frame.ray_x[3] == static_cast<float>(rays[3].x));
  CHECK(frame.unrounded_ray_y[3] == rays[3].y);
  add_rays(sensor, false, frame);
  CHECK(frame.unrounded_ray_y.empty());
}

TEST_CASE("a ray whose distortion is inverted arrives where it should, and none comes from beyond the fold") {
  Sensor sensor;
  sensor.resolution = {8, 1};
  sensor.pixel_pitch_m = {2e-3, 2e-3};
  sensor.focal_length_m = 10e-3;
  sensor.distortion = BrownConrady{-0.2};
  const std::vector<glm::dvec3> rays = rays_of(sensor);
  const double slope = rays[5].x / rays[5].z; // of x (1 - 0.2 x^2) = 0.3
  CHECK(slope * (1.0 - 0.2 * slope * slope) == Approx(0.3).epsilon(1e-12));
  sensor.distortion = BrownConrady{-1.0}; // at most 0.385
  const std::vector<glm::dvec3> folded = rays_of(sensor);
  CHECK(!std::isnan(folded[4].x));
  CHECK(std::isnan(folded[6].x));
}

TEST_CASE("the normal of a tilted plane turns to the lens, whichever side it shows and wherever it stands") {
  const Pose world_from_camera = any_pose();
  SceneBuilder builder(world_from_camera);
  const glm::dvec3 a(-1, -1, 2), b(1, -1, 2), c(1, 1, 3);
  builder.add_triangle(a, b, c);
  builder.add_triangle(a, c, b);
  builder.add_triangle(a, b, b);
  Scene scene = builder.scene();
  const Pose camera_from_world = inverse(world_from_camera);
  const glm::dvec3 expected = glm::dvec3(0.0, 1.0, -2.0) / std::sqrt(5.0);
  check_vector(seen_normal(scene, camera_from_world, 0), expected);
  check_vector(seen_normal(scene, camera_from_world, 1), expected);
  CHECK(std::isnan(seen_normal(scene, camera_from_world, 2).x));
  scene.discs.push_back({scene.triangles[0].vertices[2], 0.1, 0, 0}); // at c
  check_vector(seen_normal(scene, camera_from_world, 3), -glm::normalize(c));
  Sensor sensor;
  sensor.world_from_camera = world_from_camera;
  Measurement frame;
  frame.triangle_id = {1, no_id};
  add_normals(scene, sensor, false, frame);
  CHECK(frame.normal_z[0] == static_cast<float>(expected.z));
  CHECK(std::isnan(frame.normal_x[1]));
}
