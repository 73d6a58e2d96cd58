#include "host/input/gltf/loader.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"

#include <cmath>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::EndsWith;
using nlohmann::json;

namespace {

json with_nodes(const json &nodes, const json &roots = {0}) {
  json gltf = one_triangle();
  gltf["nodes"] = nodes;
  gltf["scenes"][0]["nodes"] = roots;
  return gltf;
}

double distance(const glm::dvec3 &a, const glm::dvec3 &b) { return glm::length(a - b); }

glm::dvec3 front_of(const Scene &scene) {
  const Triangle &triangle = scene.triangles.at(0);
  const auto corner = [&](std::size_t i) { return scene.positions_m[triangle.vertices[i]]; };
  return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

} // namespace

TEST_CASE("Translation, rotation and scale apply in glTF's order, parents outside") {
  const double half_turn = std::sqrt(0.5); // 90 degrees about y: x to -z, z to x
  const Scene scene = gltf_scene_of(with_nodes({{{"translation", {10, 0, 0}}, {"children", {1}}},
                                                {{"mesh", 0},
                                                 {"translation", {0, 0, 5}},
                                                 {"rotation", {0, half_turn, 0, half_turn}},
                                                 {"scale", {2, 3, 4}}}}))
                          .scene;
  // (-1, -1, -1) scaled (-2, -3, -4), turned (-4, -3, 2), moved (6, -3, 7).
  CHECK(distance(scene.positions_m.at(0), {6, -3, 7}) < 1e-12);
  CHECK(distance(front_of(scene), {1, 0, 0}) < 1e-12);
}

TEST_CASE("A matrix is column-major and kept in double") {
  const Scene scene =
      gltf_scene_of(
          with_nodes({{{"mesh", 0}, {"matrix", {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1e6, 0, 1e-7, 1}}}}))
          .scene;
  CHECK(scene.positions_m.at(0) == glm::dvec3(1e6 - 1, -1, 1 + 1e-7));
}

TEST_CASE("A mirrored node keeps its front in front") {
  const Scene plain = gltf_scene_of(with_nodes({{{"mesh", 0}}})).scene;
  const Scene mirrored = gltf_scene_of(with_nodes({{{"mesh", 0}, {"scale", {-1, 1, 1}}}})).scene;
  CHECK(front_of(plain) == glm::dvec3(0, 0, 1));
  CHECK(front_of(mirrored) == glm::dvec3(0, 0, 1));
  CHECK(mirrored.positions_m.at(0) == glm::dvec3(1, -1, -1));
}

TEST_CASE("A node scaled to nothing keeps its triangles, which ids count") {
  CHECK(gltf_scene_of(with_nodes({{{"mesh", 0}, {"scale", {0, 0, 0}}}})).scene.triangles.size() == 1);
  CHECK(gltf_scene_of(with_nodes({{{"mesh", 0}, {"scale", {1, 0, 1}}}})).scene.triangles.size() == 1);
}

TEST_CASE("Only the active scene is loaded") {
  json gltf = with_nodes({{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}});
  gltf["scenes"].push_back({{"nodes", {1}}});
  CHECK(gltf_scene_of(gltf).scene.objects == std::vector<std::string>{"a"});
  gltf["scene"] = 1;
  CHECK(gltf_scene_of(gltf).scene.objects == std::vector<std::string>{"b"});
  gltf.erase("scene");
  CHECK(gltf_scene_of(gltf).scene.objects == std::vector<std::string>{"a"});
}

TEST_CASE("Chains of 10,000 nodes") {
  json nodes = json::array();
  for (int i = 0; i < 10'000; ++i)
    nodes.push_back({{"translation", {0, 0, -0.5}}, {"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  CHECK(gltf_scene_of(with_nodes(nodes)).scene.positions_m.at(0) == glm::dvec3(-1, -1, -5001));
}

TEST_CASE("Nodes that are no tree are refused") {
  CHECK_THAT(scene_error_of(with_nodes({{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}})),
             EndsWith("/nodes/1: is the child of two nodes"));
  CHECK_THAT(scene_error_of(with_nodes({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}})),
             EndsWith("/nodes/1: the nodes form a cycle"));
  CHECK_THAT(scene_error_of(with_nodes({{{"children", {0}}}})), EndsWith("/nodes/0: the nodes form a cycle"));
  CHECK_THAT(scene_error_of(with_nodes({{{"children", {1}}}, {{"mesh", 0}}}, {0, 1})),
             EndsWith("/scenes/0/nodes/1: node 1 is the child of another, expected a root"));
  CHECK_THAT(scene_error_of(with_nodes({{{"mesh", 0}}}, {0, 0})),
             EndsWith("/scenes/0/nodes/1: node 0 is listed twice"));
}

TEST_CASE("Transforms that are none are refused") {
  CHECK_THAT(scene_error_of(with_nodes({{{"mesh", 0}, {"rotation", {0, 0, 0, 0}}}})),
             EndsWith("/nodes/0/rotation: expected a unit quaternion x, y, z, w, found one of length 0"));
  CHECK_THAT(scene_error_of(with_nodes({{{"mesh", 0}, {"rotation", {0, 90, 0, 0}}}})), // degrees
             EndsWith("/nodes/0/rotation: expected a unit quaternion x, y, z, w, found one of length 90"));
  CHECK_THAT(scene_error_of(
                 with_nodes({{{"mesh", 0}, {"matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}})),
             EndsWith("/nodes/0/matrix: expected 0, 0, 0, 1 as the last row"));
  CHECK_THAT(
      scene_error_of(with_nodes({{{"scale", {1e300, 1, 1}}, {"children", {1}}}, {{"scale", {1e300, 1, 1}}}})),
      EndsWith("/nodes/1: its transform is not finite"));
  CHECK_THAT(scene_error_of(
                 with_nodes({{{"mesh", 0}, {"scale", {1e308, 1, 1}}, {"translation", {-1.5e308, 0, 0}}}})),
             EndsWith("/meshes/0/primitives/0: vertex 0 lies outside the world, expected coordinates from "
                      "-1000000000 to 1000000000 m"));
  CHECK_THAT(scene_error_of(with_nodes(
                 {{{"scale", {1, 1, 1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}})),
             EndsWith("/nodes/0: expected a matrix or translation, rotation and scale, found both"));
}

TEST_CASE("An object without a name takes that of the nearest node above that has one") {
  json gltf = with_nodes({{{"name", "above"}, {"children", {1}}}, {{"children", {2}}}, {{"mesh", 0}}});
  gltf["scenes"][0]["nodes"] = {0};
  CHECK(gltf_scene_of(gltf).scene.objects == std::vector<std::string>{"above"});
}
