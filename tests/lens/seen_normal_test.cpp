#include "engine/lens/view_channels.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;

namespace {

// A triangle in the plane z = 1 whose front looks along +z, and a disc.
Scene triangle_and_disc() {
  Scene scene;
  scene.positions_m = {{0, 0, 1}, {2, 0, 1}, {0, 3, 1}, {4, 0, 0}};
  scene.surfaces = {Surface{}};
  scene.triangles = {{{0, 1, 2}, 0, 0}};
  scene.discs = {{3, 0.1, 0, 0}};
  return scene;
}

// From the camera's frame, turned as the world's, with the lens at the origin.
Pose seen_from(const glm::dvec3 &lens_m) { return inverse(Pose{glm::dmat3(1.0), lens_m}); }

} // namespace

TEST_CASE("a triangle's normal is on the side of the lens, whichever way its front looks") {
  const Scene scene = triangle_and_disc();
  CHECK(seen_normal(scene, seen_from({0, 0, 5}), 0) == glm::dvec3(0, 0, 1));
  CHECK(seen_normal(scene, seen_from({7, -3, -5}), 0) == glm::dvec3(0, 0, -1));
}

TEST_CASE("a disc's normal is the way to the lens") {
  const glm::dvec3 normal = seen_normal(triangle_and_disc(), seen_from({4, 3, 4}), 1);
  CHECK(normal.x == 0.0);
  CHECK(normal.y == Approx(0.6));
  CHECK(normal.z == Approx(0.8));
}

TEST_CASE("where a pixel sees nothing there is no normal") {
  const std::vector<std::uint32_t> ids{0, no_id, 1};
  // The camera looks along the world's -x with z up, from (4, 0, 2).
  const Pose world_from_camera{glm::dmat3(0, 1, 0, 0, 0, -1, -1, 0, 0), {4, 0, 2}};
  const std::vector<glm::vec3> normals = seen_normals_in_world(triangle_and_disc(), ids, world_from_camera);
  REQUIRE(normals.size() == 3);
  CHECK(normals[0] == glm::vec3(0, 0, 1));
  CHECK((std::isnan(normals[1].x) && std::isnan(normals[1].y) && std::isnan(normals[1].z)));
  CHECK(normals[2] == glm::vec3(0, 0, 1));
}
