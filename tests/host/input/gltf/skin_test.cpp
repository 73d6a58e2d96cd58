#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"
#include "tests/host/input/gltf/moving_gltf.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

json &attributes_of(json &gltf) { return gltf["meshes"][0]["primitives"][0]["attributes"]; }

void check_positions(const Scene &scene, const std::vector<glm::dvec3> &expected) {
  REQUIRE(scene.positions_m.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO("vertex " << i);
    CHECK(glm::length(scene.positions_m[i] - expected[i]) < float_rounding);
  }
}

json bent_arm() {
  json gltf = skinned_arm();
  const std::vector<float> q = quarter_turn();
  animate(gltf, 2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, q[0], q[1], q[2], q[3]});
  return gltf;
}

const std::vector<glm::dvec3> rest = {{0, 0, 0}, {1, 1, 0}, {0, 2, 0}};
// About (0, 1, 0): the middle vertex goes to (0, 2, 0), half of the way counts; the last to (-1, 1, 0).
const std::vector<glm::dvec3> bent = {{0, 0, 0}, {0.5, 1.5, 0}, {-1, 1, 0}};

} // namespace

TEST_CASE("A skin at rest gives the mesh back") { check_positions(file_of(skinned_arm()).at(0).scene, rest); }

TEST_CASE("A skin bends with its joints") {
  const GltfFile file = file_of(bent_arm());
  CHECK(file.moves());
  check_positions(file.at(0).scene, rest);
  check_positions(file.at(1).scene, bent);
}

TEST_CASE("A skinned mesh's own node moves it nowhere, its joints' parents do") {
  json gltf = bent_arm();
  gltf["nodes"][0]["translation"] = {100, 0, 0};
  gltf["nodes"][0]["scale"] = {-1, 1, 1};
  gltf["nodes"].push_back({{"translation", {0, 0, 7}}, {"children", {1}}});
  gltf["scenes"][0]["nodes"] = {0, 3};
  const Scene scene = file_of(gltf).at(1).scene;
  check_positions(
      scene, {bent[0] + glm::dvec3(0, 0, 7), bent[1] + glm::dvec3(0, 0, 7), bent[2] + glm::dvec3(0, 0, 7)});
  CHECK(scene.triangles.at(0).vertices == std::array<std::uint32_t, 3>{0, 1, 2});
}

TEST_CASE("Without inverse bind matrices the mesh is in its joints' frames") {
  json gltf = skinned_arm();
  gltf["skins"][0].erase("inverseBindMatrices");
  check_positions(file_of(gltf).at(0).scene, {{0, 0, 0}, {1, 1.5, 0}, {0, 3, 0}});
}

TEST_CASE("More inverse bind matrices than joints, and joints of 16 bit") {
  json gltf = bent_arm();
  std::vector<float> matrices(48, 0.0f);
  for (const std::size_t i : {0u, 5u, 10u, 15u})
    matrices[i] = matrices[16 + i] = 1.0f;
  matrices[29] = -1.0f;
  gltf["skins"][0]["inverseBindMatrices"] = add_floats(gltf, matrices, "MAT4");
  attributes_of(gltf)["JOINTS_0"] =
      add_accessor(gltf, bytes_of<std::uint16_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}), 5123, 3, "VEC4");
  check_positions(file_of(gltf).at(1).scene, bent);
}

TEST_CASE("Weights count by their share of the sum") {
  json gltf = bent_arm();
  attributes_of(gltf)["WEIGHTS_0"] =
      add_floats(gltf, {3, 0, 0, 0, 0.25f, 0.25f, 0, 0, 0.5f, 0, 0, 0}, "VEC4");
  check_positions(file_of(gltf).at(1).scene, bent);

  const std::size_t bytes =
      add_accessor(gltf, bytes_of<std::uint8_t>({255, 0, 0, 0, 64, 192, 0, 0, 9, 0, 0, 0}), 5121, 3, "VEC4");
  gltf["accessors"][bytes]["normalized"] = true;
  attributes_of(gltf)["WEIGHTS_0"] = bytes;
  check_positions(file_of(gltf).at(1).scene, {bent[0], {0.25, 1.75, 0}, bent[2]});
}

TEST_CASE("Further sets of joints and weights add to the first") {
  json gltf = bent_arm();
  attributes_of(gltf)["JOINTS_1"] =
      add_accessor(gltf, bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}), 5121, 3, "VEC4");
  attributes_of(gltf)["WEIGHTS_1"] = add_floats(gltf, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
  check_positions(file_of(gltf).at(1).scene, {bent[0], {0.25, 1.75, 0}, bent[2]});
}

TEST_CASE("A triangle that its joints mirror keeps its front in front") {
  json gltf = skinned_arm();
  gltf["nodes"][1]["scale"] = {-1, 1, 1};
  const Scene scene = file_of(gltf).at(0).scene;
  check_positions(scene, {{0, 0, 0}, {-1, 1, 0}, {0, 2, 0}});
  CHECK(scene.triangles.at(0).vertices == std::array<std::uint32_t, 3>{0, 2, 1});
}

TEST_CASE("A mirrored triangle is known by its first corner") {
  json gltf = skinned_arm();
  gltf["nodes"][2]["scale"] = {-1, 1, 1}; // of the last vertex only, the middle one is flat
  CHECK(file_of(gltf).at(0).scene.triangles.at(0).vertices == std::array<std::uint32_t, 3>{0, 1, 2});
  attributes_of(gltf)["JOINTS_0"] =
      add_accessor(gltf, bytes_of<std::uint8_t>({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5121, 3, "VEC4");
  CHECK(file_of(gltf).at(0).scene.triangles.at(0).vertices == std::array<std::uint32_t, 3>{0, 2, 1});
}

TEST_CASE("One mesh with two skins, and once without") {
  json gltf = bent_arm();
  gltf["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  gltf["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
  gltf["scenes"][0]["nodes"] = {0, 1, 3, 4};
  gltf["skins"].push_back({{"joints", {1, 1}}}); // both the lower one
  const Scene scene = file_of(gltf).at(1).scene;
  std::vector<glm::dvec3> expected = bent;
  expected.insert(expected.end(), rest.begin(), rest.end());
  for (const glm::dvec3 &position : rest)
    expected.push_back(position + glm::dvec3(0, 0, 5));
  check_positions(scene, expected);
}

TEST_CASE("Nodes that place the same skinned mesh again and again are limited by its weights") {
  json gltf = skinned_arm();
  constexpr int sets = 4096; // three vertices' of four weights
  for (const char *name : {"JOINTS_", "WEIGHTS_"})
    for (int n = 1; n < sets; ++n)
      attributes_of(gltf)[fmt::format("{}{}", name, n)] = attributes_of(gltf)[fmt::format("{}0", name)];
  const json node = gltf["nodes"][0];
  for (int i = 0; i < 30'000; ++i) {
    gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
    gltf["nodes"].push_back(node);
  }
  CHECK_THAT(scene_error_of(gltf), Catch::Contains("nodes place more than 268435456 weights of skins"));
}
