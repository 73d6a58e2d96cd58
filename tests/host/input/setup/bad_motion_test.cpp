// Animations and skins that are none.

#include "host/input/gltf/loader.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/moving_gltf.h"
#include "tests/support/temporary_folder.h"

#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// The error of loading alone: that is when all this is found.
std::string error_of(const json &gltf) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.gltf", gltf.dump());
  return input_error_of([&] { load_gltf(file, Place{file}); });
}

json moving() {
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 3, 0, 0});
  return gltf;
}

std::string error_with(json gltf, const std::string &pointer, const json &value) {
  gltf[json::json_pointer(pointer)] = value;
  return error_of(gltf);
}

std::string error_of_times(const std::vector<float> &times_s) {
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "STEP", times_s, std::vector<float>(3 * times_s.size(), 0.0f));
  return error_of(gltf);
}

// The arm with another accessor for one of its attributes.
std::string error_of_attribute(const std::string &name, const std::string &bytes, int component_type,
                               std::size_t count = 3, bool normalized = false) {
  json gltf = skinned_arm();
  const std::size_t accessor = add_accessor(gltf, bytes, component_type, count, "VEC4");
  gltf["accessors"][accessor]["normalized"] = normalized;
  gltf["meshes"][0]["primitives"][0]["attributes"][name] = accessor;
  return error_of(gltf);
}

std::string error_of_weights(const std::vector<float> &weights) {
  return error_of_attribute("WEIGHTS_0", bytes_of(weights), 5126, weights.size() / 4);
}

} // namespace

TEST_CASE("Animations that refer to nothing") {
  CHECK_THAT(error_with(moving(), "/animations/0/channels/0/target/node", 4),
             EndsWith("/animations/0/channels/0/target/node: index 4 into /nodes, which has 1"));
  CHECK_THAT(error_with(moving(), "/animations/0/channels/0/sampler", 1),
             EndsWith("/animations/0/channels/0/sampler: index 1 into /animations/0/samplers, which has 1"));
  CHECK_THAT(error_with(moving(), "/animations/0/samplers/0/input", 9),
             EndsWith("/animations/0/samplers/0/input: index 9 into /accessors, which has 3"));
  CHECK_THAT(error_with(moving(), "/animations/0/samplers/0/output", 9), Contains("/output: index 9"));
}

TEST_CASE("Animations that lack something or have it wrong") {
  CHECK_THAT(error_with(one_triangle(), "/animations", json::array({json::object()})),
             Contains("/animations/0: missing key \"channels\""));
  json gltf = moving();
  gltf["animations"][0]["samplers"][0].erase("input");
  CHECK_THAT(error_of(gltf), Contains("/animations/0/samplers/0: missing key \"input\""));
  CHECK_THAT(error_with(moving(), "/animations/0/samplers/0/interpolation", "BEZIER"),
             Contains("/interpolation: expected") && Contains("\"BEZIER\""));
  CHECK_THAT(error_with(moving(), "/animations/0/channels/0/target/path", "colour"),
             EndsWith("/target/path: expected \"translation\", \"rotation\" or \"scale\", found \"colour\""));
}

TEST_CASE("Animations of what cannot be animated") {
  CHECK_THAT(error_with(moving(), "/animations/0/channels/0/target/path", "weights"),
             EndsWith("/animations/0/channels/0/target/path: morph targets are not supported yet, nor their "
                      "animation"));
  CHECK_THAT(error_with(moving(), "/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
             EndsWith("/target/path: node 0 has a matrix, expected none where its translation is animated"));
}

TEST_CASE("Two channels for one property") {
  json gltf = moving();
  animate(gltf, 0, "scale", "STEP", {0}, {1, 1, 1});
  animate(gltf, 0, "translation", "STEP", {0}, {1, 1, 1});
  CHECK_THAT(error_of(gltf),
             EndsWith("/animations/2/channels/0/target: the translation of node 0 is animated "
                      "by /animations/0/channels/0 too"));
}

TEST_CASE("Times that are none") {
  const std::string expected = " s, expected times from 0 s on, each after the one before";
  CHECK_THAT(error_of_times({0, 2, 1}), EndsWith("/accessors/1: element 2 is 1" + expected));
  CHECK_THAT(error_of_times({0, 1, 1}), EndsWith("/accessors/1: element 2 is 1" + expected));
  CHECK_THAT(error_of_times({-1, 1}), EndsWith("/accessors/1: element 0 is -1" + expected));
  CHECK_THAT(error_of_times({0, std::nanf("")}), EndsWith("/accessors/1: element 1 is not finite"));
  CHECK_THAT(error_of_times({0, INFINITY}), EndsWith("/accessors/1: element 1 is not finite"));
  CHECK_THAT(error_with(moving(), "/accessors/1/componentType", 5125),
             EndsWith("/accessors/1/componentType: expected 5126 (float) for an animation's times"));
  CHECK_THAT(error_with(moving(), "/animations/0/samplers/0/input", 2),
             Contains("/accessors/2/type: expected \"SCALAR\""));
}

TEST_CASE("Values that are none") {
  CHECK_THAT(error_with(moving(), "/accessors/2/count", 1),
             EndsWith("/animations/0/samplers/0/output: has 1 elements, expected 2 for 2 times"));
  CHECK_THAT(error_with(moving(), "/animations/0/samplers/0/interpolation", "CUBICSPLINE"),
             EndsWith("/animations/0/samplers/0/output: has 2 elements, expected 6 for 2 times"));
  CHECK_THAT(error_with(moving(), "/animations/0/channels/0/target/path", "rotation"),
             EndsWith("/accessors/2/type: expected \"VEC4\""));
  CHECK_THAT(
      error_with(moving(), "/accessors/2/componentType", 5122),
      EndsWith("/accessors/2/componentType: expected 5126 (float) for an animated translation or scale"));
  json gltf = one_triangle();
  animate(gltf, 0, "scale", "STEP", {0, 1}, {1, 1, 1, 1, std::nanf(""), 1});
  CHECK_THAT(error_of(gltf), EndsWith("/accessors/2: element 1 is not finite"));
  CHECK_THAT(error_with(moving(), "/accessors/2/byteOffset", 4),
             Contains("/accessors/2: 2 elements end at byte 28"));
}

TEST_CASE("Rotations that are none") {
  json gltf = one_triangle();
  animate(gltf, 0, "rotation", "STEP", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0});
  CHECK_THAT(error_of(gltf), EndsWith("/accessors/2: element 1 is no unit quaternion"));
  gltf = one_triangle();
  animate(gltf, 0, "rotation", "CUBICSPLINE", {0}, {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1});
  CHECK_THAT(error_of(gltf), EndsWith("/accessors/2: element 1 is no unit quaternion"));
  const std::string expected = "/accessors/2/componentType: expected floats or normalized integers of 8 or "
                               "16 bit for an animated rotation";
  CHECK_THAT(error_with(gltf, "/accessors/2/componentType", 5122), EndsWith(expected));
}

TEST_CASE("More keys than an animation may have") {
  json gltf = moving();
  gltf["accessors"][1]["count"] = gltf["accessors"][2]["count"] = (1u << 24) + 1;
  CHECK_THAT(error_of(gltf),
             EndsWith("/animations/0/samplers/0: the animations have more than 16777216 keys"));
}

TEST_CASE("What is outside the active scene is checked too") {
  json gltf = moving();
  gltf["scenes"][0]["nodes"] = json::array();
  gltf["accessors"][2]["count"] = 1;
  CHECK_THAT(error_of(gltf), Contains("has 1 elements, expected 2"));
}

TEST_CASE("An animated node that leaves the world is told when it does") {
  const TemporaryFolder folder;
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 3e9f, 0, 0});
  const auto path = folder.write("scene.gltf", gltf.dump());
  const GltfFile file = load_gltf(path, Place{path});
  CHECK_NOTHROW(file.at(0.3));
  CHECK_THAT(input_error_of([&] { file.at(0.4); }), Contains("vertex 0 lies outside the world"));
}

TEST_CASE("Skins that refer to nothing") {
  CHECK_THAT(error_with(skinned_arm(), "/nodes/0/skin", 1),
             EndsWith("/nodes/0/skin: index 1 into /skins, which has 1"));
  CHECK_THAT(error_with(skinned_arm(), "/skins/0/joints/1", 7),
             EndsWith("/skins/0/joints/1: index 7 into /nodes, which has 3"));
  CHECK_THAT(error_with(skinned_arm(), "/skins/0/inverseBindMatrices", 7),
             EndsWith("/skins/0/inverseBindMatrices: index 7 into /accessors, which has 4"));
  CHECK_THAT(error_with(skinned_arm(), "/skins/0/joints", json::array()),
             Contains("/skins/0/joints: expected"));
  json gltf = skinned_arm();
  gltf["nodes"][0].erase("mesh");
  CHECK_THAT(error_of(gltf), EndsWith("/nodes/0/skin: expected a mesh beside it"));
}

TEST_CASE("Joints that are not there") {
  json gltf = skinned_arm();
  gltf["nodes"][1].erase("children"); // node 2 is in no scene
  CHECK_THAT(error_of(gltf), EndsWith("/skins/0/joints/1: node 2 is not in the active scene"));
  CHECK_THAT(
      error_of_attribute("JOINTS_0", bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0}), 5121),
      EndsWith("/meshes/0/primitives/0/attributes: refers to joint 2, expected one below 2, as skin 0 "
               "has"));
  CHECK_THAT(
      error_of_attribute("JOINTS_0", bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 9}), 5121),
      Contains("refers to joint 9")); // without weight
  gltf = skinned_arm();
  gltf["nodes"][2]["children"] = {1};
  CHECK_THAT(error_of(gltf), EndsWith("the nodes form a cycle"));
}

TEST_CASE("Inverse bind matrices that are none") {
  const auto error_of_matrices = [](const std::vector<float> &values) {
    json gltf = skinned_arm();
    gltf["skins"][0]["inverseBindMatrices"] = add_floats(gltf, values, "MAT4");
    return error_of(gltf);
  };
  std::vector<float> matrices(32, 0.0f);
  for (const std::size_t i : {0u, 5u, 10u, 15u})
    matrices[i] = matrices[16 + i] = 1.0f;
  CHECK_THAT(error_of_matrices(std::vector<float>(matrices.begin(), matrices.begin() + 16)),
             EndsWith("/accessors/4/count: expected at least 2, found 1"));
  matrices[19] = 0.5f;
  CHECK_THAT(error_of_matrices(matrices),
             EndsWith("/skins/0/inverseBindMatrices: matrix 1: expected 0, 0, 0, 1 as the last row"));
  matrices[19] = std::nanf("");
  CHECK_THAT(error_of_matrices(matrices), EndsWith("/accessors/4: element 1 is not finite"));
  CHECK_THAT(error_with(skinned_arm(), "/skins/0/inverseBindMatrices", 0),
             EndsWith("/accessors/0/type: expected \"MAT4\" of floats"));
}

TEST_CASE("Weights that are none") {
  CHECK_THAT(error_of_weights({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}),
             EndsWith("/meshes/0/primitives/0/attributes/WEIGHTS_0: the weights of vertex 1 are all 0"));
  CHECK_THAT(error_of_weights({1, 0, 0, 0, 2, -1, 0, 0, 1, 0, 0, 0}),
             EndsWith("/accessors/4: element 1 has a negative weight"));
  CHECK_THAT(error_of_weights({1, 0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0, 0, 0}),
             EndsWith("/accessors/4: element 1 is not finite"));
  CHECK_THAT(error_of_weights({1, 0, 0, 0, 1, 0, 0, 0}),
             EndsWith("/meshes/0/primitives/0/attributes/WEIGHTS_0: has 2 elements, POSITION has 3"));
}

TEST_CASE("Joints and weights of a wrong type or alone") {
  const std::string twelve_bytes(12, '\0'), floats(48, '\0');
  CHECK_THAT(error_of_attribute("JOINTS_0", floats, 5126),
             EndsWith("/accessors/4/componentType: expected 5121 or 5123, not normalized, for joints"));
  CHECK_THAT(error_of_attribute("JOINTS_0", twelve_bytes, 5121, 3, true),
             Contains("not normalized, for joints"));
  CHECK_THAT(error_of_attribute("WEIGHTS_0", twelve_bytes, 5121),
             EndsWith("/accessors/4/componentType: expected 5126, or 5121 or 5123 normalized, for weights"));
  CHECK_THAT(error_of_attribute("WEIGHTS_1", floats, 5126),
             EndsWith("/meshes/0/primitives/0/attributes: missing key \"JOINTS_1\""));
  json gltf = skinned_arm();
  gltf["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
  CHECK_THAT(error_of(gltf), EndsWith("/meshes/0/primitives/0/attributes: missing key \"JOINTS_0\""));
}

TEST_CASE("More vertices than skins may bind") {
  json gltf = skinned_arm();
  for (const std::size_t accessor : {0u, 2u, 3u})
    gltf["accessors"][accessor]["count"] = (1u << 25) + 1;
  CHECK_THAT(error_of(gltf), EndsWith("/meshes/0/primitives/0: skins bind more than 33554432 vertices"));
}
