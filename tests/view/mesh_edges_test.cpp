// Which triangle lies beyond which edge, as the search walks over a mesh.

#include "engine/view/mesh_edges.h"

#include "tests/support/scenes.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t none = shader::no_triangle;

using Beyond = std::array<std::uint32_t, 3>;

std::vector<Beyond> beyond_of(const Scene &scene) {
  std::vector<Beyond> all;
  for (const shader::TriangleCorners &corners : triangle_corners(to_camera(scene, Sensor()), scene))
    all.push_back({corners.beyond[0], corners.beyond[1], corners.beyond[2]});
  return all;
}

// Two squares side by side, at z = 2; each of its own vertices: 0 1 | 4 5 above, 3 2 | 7 6 below.
Scene two_squares(const Surface &right = {}) {
  SceneBuilder builder;
  builder.add_mesh({{-1, -1, 2}, {0, -1, 2}, {0, 1, 2}, {-1, 1, 2}}, {{0, 2, 1}, {0, 3, 2}});
  builder.add_mesh({{0, -1, 2}, {1, -1, 2}, {1, 1, 2}, {0, 1, 2}}, {{0, 2, 1}, {0, 3, 2}}, right);
  return builder.scene();
}

} // namespace

TEST_CASE("neighbours share an edge, across seams too, and borders have none") {
  // Triangle 0 is top left, right of its diagonal; its edges: the diagonal, the seam, the upper border.
  const auto beyond = beyond_of(two_squares());
  REQUIRE(beyond.size() == 4);
  CHECK(beyond[0] == Beyond{1, 3, none});
  CHECK(beyond[1] == Beyond{none, none, 0});
  CHECK(beyond[2] == Beyond{3, none, none});
  CHECK(beyond[3] == Beyond{0, none, 2});
}

TEST_CASE("triangles that the lens cannot see are nobody's neighbours") {
  Scene scene = two_squares();
  std::swap(scene.triangles[3].vertices[0], scene.triangles[3].vertices[1]); // turned away
  const auto beyond = beyond_of(scene);
  CHECK(beyond[0] == Beyond{1, none, none});
  CHECK(beyond[2] == Beyond{none, none, none});
}

TEST_CASE("where three triangles share an edge each still has a neighbour there") {
  SceneBuilder builder;
  builder.add_mesh({{0, -1, 2}, {0, 1, 2}, {1, 0, 2}, {-1, 0, 2}, {-1, 0, 3}},
                   {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {0, 3, 4}}, {1.0, true});
  const auto beyond = beyond_of(builder.scene());
  for (const std::uint32_t triangle : {0u, 1u, 2u}) {
    const std::uint32_t neighbour = beyond[triangle][0];
    CHECK(neighbour < 3);
    CHECK(neighbour != triangle);
  }
  CHECK(beyond[1][2] == 3); // the other edges are as they were
  CHECK(beyond[3][0] == 1);
}

TEST_CASE("corners are the triangle's, in the camera frame, in the triangle's order") {
  Sensor sensor;
  sensor.world_from_camera.translation_m = {1000.1, -200.2, 300.3};
  SceneBuilder builder(sensor.world_from_camera);
  const std::array<glm::dvec3, 3> corners_m{{{0.1, 0.2, 2.3}, {0.7, 0.3, 2.1}, {0.4, 0.9, 1.7}}};
  builder.add_triangle(corners_m[0], corners_m[1], corners_m[2], {1.0, true});
  const auto records = triangle_corners(to_camera(builder.scene(), sensor), builder.scene());
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec2 pair(records[0].corners[3 * k + axis]);
      CHECK(pair.x + pair.y == Approx(corners_m[static_cast<std::size_t>(k)][axis]).margin(1e-12));
    }
}
