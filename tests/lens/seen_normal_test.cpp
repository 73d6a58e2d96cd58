#include "engine/lens/seen_normal.h"

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

} // namespace

TEST_CASE("a triangle's normal is on the side of the lens, whichever way its front looks") {
  const Scene scene = triangle_and_disc();
  CHECK(seen_normal(scene, 0, {0, 0, 5}) == glm::dvec3(0, 0, 1));
  CHECK(seen_normal(scene, 0, {7, -3, -5}) == glm::dvec3(0, 0, -1));
}

TEST_CASE("a disc's normal is the way to the lens") {
  const glm::dvec3 normal = seen_normal(triangle_and_disc(), 1, {4, 3, 4});
  CHECK(normal.x == 0.0);
  CHECK(normal.y == Approx(0.6));
  CHECK(normal.z == Approx(0.8));
}

TEST_CASE("where a pixel sees nothing there is no normal") {
  const std::vector<std::uint32_t> ids{0, no_id, 1};
  const std::vector<glm::vec3> normals = seen_normals(triangle_and_disc(), ids, {4, 0, 2});
  REQUIRE(normals.size() == 3);
  CHECK(normals[0] == glm::vec3(0, 0, 1));
  CHECK((std::isnan(normals[1].x) && std::isnan(normals[1].y) && std::isnan(normals[1].z)));
  CHECK(normals[2] == glm::vec3(0, 0, 1));
}
