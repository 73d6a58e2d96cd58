// Which fragments have lists, and of which shapes.

#include "engine/view/rim_cells.h"

#include "engine/view/mesh_edges.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <map>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// 40 x 40 fragments, ten a metre at z = 1.
RasterBlock block() { return {{0, 0}, {40, 40}, {40, 40}, {10, 0, 0, 0, 10, 0, 20, 20, 1}, true}; }

// Row and column of each cell, and its candidates in their order.
using Lists = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>;

Lists lists_of(const Scene &scene) {
  const Sensor sensor;
  const CameraScene camera = to_camera(scene, sensor);
  const RimCells rims = find_rim_cells(camera, scene, triangle_corners(camera, scene), {block()});
  REQUIRE(rims.end_of_block == std::vector{static_cast<std::uint32_t>(rims.cells.size())});
  Lists lists;
  for (const auto &[fragment, first] : rims.cells) {
    std::vector<std::uint32_t> &list = lists[{fragment / 40, fragment % 40}];
    for (std::uint32_t i = first; rims.candidates[i].shape != shader::no_triangle; ++i)
      list.push_back(rims.candidates[i].shape);
  }
  return lists;
}

using List = std::vector<std::uint32_t>;

// From (-1.45, -1.45) to (1.45, 1.45) at z = 1: fragments 5.5 to 34.5 in both directions.
Scene square() {
  SceneBuilder builder;
  builder.add_wall({1.0, {}, {-1.45, -1.45}, {1.45, 1.45}});
  return builder.scene();
}

} // namespace

TEST_CASE("a mesh has rims along its border and none within") {
  const Lists lists = lists_of(square());
  CHECK(lists.size() == 4 * 29);
  CHECK(lists.contains({5, 20}));
  CHECK_FALSE(lists.contains({20, 20})); // its diagonal
  CHECK_FALSE(lists.contains({4, 20}));
  CHECK_FALSE(lists.contains({6, 20}));
}

TEST_CASE("a rim cell knows what is behind the rim, but nothing that is hidden all over it") {
  SceneBuilder builder;
  builder.add_wall({1.0, {}, {-1.45, -1.45}, {1.45, 1.45}});
  builder.add_wall({1.2, {}, {-10, -10}, {10, 10}});
  builder.add_wall({1.4, {}, {-10, -10}, {10, 10}});
  const Lists lists = lists_of(builder.scene());
  REQUIRE(lists.contains({5, 30}));
  const List &list = lists.at({5, 30});
  REQUIRE(list.size() == 2);
  CHECK(list[0] < 2); // the square first
  CHECK((list[1] == 2 || list[1] == 3));
}

TEST_CASE("rims that are hidden cost no more than what hides them") {
  SceneBuilder builder;
  const std::uint32_t nearer = builder.add_triangle({-10, -10, 0.9}, {-10, 30, 0.9}, {30, -10, 0.9});
  builder.add_wall({1.0, {}, {-1.45, -1.45}, {1.45, 1.45}});
  const Lists lists = lists_of(builder.scene());
  CHECK(lists.size() == 4 * 29);
  for (const auto &[cell, list] : lists)
    CHECK(list == List{nearer});
}

TEST_CASE("a fold is a rim, a bend is none") {
  const std::vector<std::array<std::uint32_t, 3>> faces{{0, 1, 2}, {1, 0, 3}};
  SceneBuilder bend, fold;
  bend.add_mesh({{0, -1, 1}, {0, 1, 1}, {1, 0, 1.2}, {-1, 0, 1.2}}, faces, {1.0, true});
  fold.add_mesh({{0, -1, 1}, {0, 1, 1}, {1, 0, 1.2}, {1.3, 0, 1.6}}, faces, {1.0, true});
  CHECK_FALSE(lists_of(bend.scene()).contains({20, 20}));
  CHECK(lists_of(fold.scene()).contains({20, 20}));
}

TEST_CASE("a point has rims around its circle and none in its middle") {
  Scene scene;
  scene.positions_m = {node_from_camera().point({0.05, 0.05, 1})};
  scene.surfaces = {{}};
  scene.objects = {"point"};
  scene.discs = {{0, 0.8, 0, 0}};
  const Lists lists = lists_of(scene);
  CHECK_FALSE(lists.contains({20, 20}));
  CHECK_FALSE(lists.contains({20, 26}));
  CHECK(lists.contains({20, 28}));
  CHECK(lists.at({20, 28}) == List{0});
}

TEST_CASE("a surface with holes has lists wherever it is") {
  Scene scene = square();
  scene.surfaces[0].paint = Paint{};
  scene.surfaces[0].paint->alpha_cutoff = 0.5;
  CHECK(lists_of(scene).size() == 30 * 30);
}

TEST_CASE("a triangle that reaches behind the lens has rims as far as it is seen") {
  SceneBuilder builder;
  builder.add_triangle({-0.05, 0.5, 4}, {0.05, 0.5, 4}, {0.0, 0.5, -4}, {1.0, true});
  const Lists lists = lists_of(builder.scene());
  CHECK(lists.contains({21, 20}));
  CHECK(lists.contains({39, 20}));
}
