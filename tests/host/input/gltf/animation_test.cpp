#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"
#include "tests/host/input/gltf/moving_gltf.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

// The triangle on node 0, one of whose properties is animated.
GltfFile animated(const std::string &path, const std::string &interpolation,
                  const std::vector<float> &times_s, const std::vector<float> &values) {
  json gltf = one_triangle();
  animate(gltf, 0, path, interpolation, times_s, values);
  return file_of(gltf);
}

glm::dvec3 translation_at(const GltfFile &file, double time_s) {
  return file.at(time_s).nodes.at(0).world_from_node.translation_m;
}

// By which the node turns x towards y.
double angle_deg_at(const GltfFile &file, double time_s) {
  const glm::dvec3 x = file.at(time_s).nodes.at(0).world_from_node.linear[0];
  CHECK(glm::length(x) == Approx(1.0).epsilon(1e-12));
  return std::atan2(x.y, x.x) * 180.0 / std::numbers::pi;
}

} // namespace

TEST_CASE("Steps hold each key until the next") {
  const GltfFile file = animated("translation", "STEP", {1, 2, 4}, {1, 0, 0, 5, 0, 0, 7, 0, 0});
  CHECK(file.moves());
  CHECK(translation_at(file, 1.0).x == 1.0);
  CHECK(translation_at(file, std::nextafter(2.0, 0.0)).x == 1.0);
  CHECK(translation_at(file, 2.0).x == 5.0);
  CHECK(translation_at(file, 3.999).x == 5.0);
  CHECK(translation_at(file, 4.0).x == 7.0);
}

TEST_CASE("Linear keys are joined by straight lines") {
  const GltfFile file = animated("translation", "LINEAR", {1, 2, 4}, {1, 0, 0, 5, -2, 0, 7, -2, 8});
  CHECK(translation_at(file, 1.25) == glm::dvec3(2.0, -0.5, 0.0));
  CHECK(translation_at(file, 2.0) == glm::dvec3(5.0, -2.0, 0.0));
  CHECK(translation_at(file, 3.5) == glm::dvec3(6.5, -2.0, 6.0));
}

TEST_CASE("Linear is what a sampler does that says nothing") {
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "STEP", {0, 1}, {0, 0, 0, 2, 0, 0});
  gltf["animations"][0]["samplers"][0].erase("interpolation");
  CHECK(translation_at(file_of(gltf), 0.25).x == 0.5);
}

TEST_CASE("A cubic spline's tangents are scaled by the time between its keys") {
  // In-tangent, value and out-tangent of x: -7, 3, 1 at 1 s; -2, 10, 9 at 3 s. At 1.5 s, a quarter of the
  // way, 0.84375 * 3 + 2 * 0.140625 * 1 + 0.15625 * 10 + 2 * -0.046875 * -2.
  const GltfFile file = animated("translation", "CUBICSPLINE", {1, 3},
                                 {-7, 0, 0, 3, 0, 0, 1, 0, 0, /* at 3 s */ -2, 0, 0, 10, 0, 0, 9, 0, 0});
  CHECK(translation_at(file, 1.5).x == 4.5625);
  CHECK(translation_at(file, 1.0).x == 3.0);
  CHECK(translation_at(file, 3.0).x == 10.0);
  CHECK(translation_at(file, 0.0).x == 3.0);
  CHECK(translation_at(file, 4.0).x == 10.0);
}

TEST_CASE("A cubic spline between its second and third key uses those") {
  const std::vector<float> key = {0, 0, 0, 1, 0, 0, 0, 0, 0}, last = {0, 0, 0, 3, 0, 0, 0, 0, 0};
  std::vector<float> values = key;
  values.insert(values.end(), key.begin(), key.end());
  values.insert(values.end(), last.begin(), last.end());
  CHECK(translation_at(animated("translation", "CUBICSPLINE", {0, 1, 2}, values), 1.5).x == 2.0);
}

TEST_CASE("Linear rotations go along the great circle at an even speed") {
  std::vector<float> turns = {0, 0, 0, 1};
  for (const float component : quarter_turn())
    turns.push_back(component);
  const GltfFile file = animated("rotation", "LINEAR", {2, 5}, turns);
  for (const double share : {0.1, 1.0 / 3.0, 0.5, 0.9})
    CHECK(angle_deg_at(file, 2.0 + 3.0 * share) == Approx(90.0 * share).margin(1e-5));
}

TEST_CASE("Linear rotations follow glTF's formula") {
  const glm::dquat from = glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2));
  const glm::dquat to = glm::normalize(glm::dquat(-0.2, 0.5, 0.4, -0.7));
  const auto f = [](double x) { return static_cast<float>(x); };
  const GltfFile file =
      animated("rotation", "LINEAR", {0, 1},
               {f(from.x), f(from.y), f(from.z), f(from.w), f(to.x), f(to.y), f(to.z), f(to.w)});
  const double dot = glm::dot(from, to);
  REQUIRE(dot < 0.0); // the other of the two quaternions of that rotation is nearer
  const double a = std::acos(std::abs(dot)), t = 0.3;
  const glm::dquat expected =
      std::sin(a * (1.0 - t)) / std::sin(a) * from - std::sin(a * t) / std::sin(a) * to;
  const glm::dmat3 difference = glm::mat3_cast(expected) - file.at(t).nodes.at(0).world_from_node.linear;
  for (glm::length_t column = 0; column < 3; ++column)
    CHECK(glm::length(difference[column]) < float_rounding);
}

TEST_CASE("Rotations take the shorter way, and none at all where both keys are the same") {
  const std::vector<float> q = quarter_turn();
  const GltfFile negated = animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, -q[0], -q[1], -q[2], -q[3]});
  CHECK(angle_deg_at(negated, 0.5) == Approx(45.0));
  const GltfFile opposite =
      animated("rotation", "LINEAR", {0, 1}, {q[0], q[1], q[2], q[3], -q[0], -q[1], -q[2], -q[3]});
  CHECK(angle_deg_at(opposite, 0.5) == Approx(90.0));
}

TEST_CASE("A cubic spline of rotations is normalised after it is made") {
  const std::vector<float> q = quarter_turn();
  const GltfFile file = animated("rotation", "CUBICSPLINE", {0, 2},
                                 {0, 0, 0, 0, 0,    0,    0,    1,    0, 0, 0.5f, 0, /* at 2 s */
                                  0, 0, 0, 0, q[0], q[1], q[2], q[3], 0, 0, 0,    0});
  // A quarter of the way: 0.84375 * from + 2 * 0.140625 * out-tangent + 0.15625 * to.
  const double z = 2.0 * 0.140625 * 0.5 + 0.15625 * std::sqrt(0.5);
  const double w = 0.84375 + 0.15625 * std::sqrt(0.5);
  CHECK(angle_deg_at(file, 0.5) == Approx(2.0 * std::atan2(z, w) * 180.0 / std::numbers::pi).margin(1e-5));
}

TEST_CASE("A cubic spline of rotations through zero holds the key before") {
  const GltfFile file = animated("rotation", "CUBICSPLINE", {0, 2},
                                 {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0});
  CHECK(angle_deg_at(file, 1.0) == 0.0);
}

TEST_CASE("Rotations may be normalized integers") {
  json gltf = one_triangle();
  animate(gltf, 0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1});
  const std::size_t output =
      add_accessor(gltf, bytes_of<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}), 5122, 2, "VEC4");
  gltf["accessors"][output]["normalized"] = true;
  gltf["animations"][0]["samplers"][0]["output"] = output;
  CHECK(angle_deg_at(file_of(gltf), 0.5) == Approx(45.0));
}

TEST_CASE("Before the first key the first holds, after the last the last") {
  const GltfFile file = animated("scale", "LINEAR", {1, 2}, {2, 3, 4, 5, 6, 7});
  const auto x_at = [&](double time_s) { return file.at(time_s).nodes.at(0).world_from_node.linear[0].x; };
  for (const double time_s : {-1e300, -1.0, 0.0, 1.0})
    CHECK(x_at(time_s) == 2.0);
  for (const double time_s : {2.0, 3.0, 1e300})
    CHECK(x_at(time_s) == 5.0);
}

TEST_CASE("One key holds always and moves nothing") {
  for (const std::string interpolation : {"STEP", "LINEAR"}) {
    const GltfFile file = animated("translation", interpolation, {1}, {3, 0, 0});
    CHECK_FALSE(file.moves());
    CHECK(translation_at(file, 0.0).x == 3.0);
    CHECK(translation_at(file, 2.0).x == 3.0);
  }
}

TEST_CASE("Only what changes in the active scene moves") {
  CHECK_FALSE(file_of(one_triangle()).moves());
  CHECK_FALSE(animated("translation", "LINEAR", {0, 1}, {3, 0, 0, 3, 0, 0}).moves());
  CHECK_FALSE(animated("scale", "CUBICSPLINE", {0, 1}, {9, 9, 9, 1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1, 9, 9, 9})
                  .moves());
  CHECK(animated("scale", "CUBICSPLINE", {0, 1}, {0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 2, 0, 1, 1, 1, 0, 0, 0})
            .moves());
  CHECK(animated("scale", "CUBICSPLINE", {0, 1}, {0, 0, 0, 1, 1, 1, 0, 2, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0})
            .moves());

  json gltf = one_triangle();
  gltf["nodes"].push_back({{"name", "elsewhere"}});
  gltf["scenes"].push_back({{"nodes", {1}}});
  animate(gltf, 1, "translation", "LINEAR", {0, 1}, {0, 0, 0, 3, 0, 0});
  CHECK_FALSE(file_of(gltf).moves());
  gltf["scene"] = 1;
  CHECK(file_of(gltf).moves());
}

TEST_CASE("Channels without a node are ignored") {
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 3, 0, 0});
  gltf["animations"][0]["channels"][0]["target"] = {{"path", "pointer"}};
  CHECK_FALSE(file_of(gltf).moves());
  CHECK(translation_at(file_of(gltf), 1.0).x == 0.0);
}

TEST_CASE("All animations of a file play at once") {
  json gltf = one_triangle();
  gltf["nodes"][0]["translation"] = {9, 9, 9}; // replaced
  gltf["nodes"][0]["scale"] = {2, 2, 2};       // kept
  animate(gltf, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 3, 0, 0});
  animate(gltf, 0, "rotation", "STEP", {0}, quarter_turn());
  const glm::dvec3 corner = file_of(gltf).at(0.5).scene.positions_m.at(0);
  // (-1, -1, -1) scaled to -2, turned to (2, -2, -2), moved by 1.5.
  CHECK(glm::length(corner - glm::dvec3(3.5, -2.0, -2.0)) < float_rounding);
}

TEST_CASE("Two channels may share a sampler") {
  json gltf = one_triangle();
  animate(gltf, 0, "translation", "LINEAR", {0, 1}, {1, 1, 1, 3, 3, 3});
  gltf["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}});
  CHECK(file_of(gltf).at(0.5).scene.positions_m.at(0) == glm::dvec3(0.0));
}

TEST_CASE("Children move with their animated parents") {
  json gltf = one_triangle();
  gltf["nodes"] = {{{"name", "turntable"}, {"children", {1}}}, {{"name", "object"}, {"mesh", 0}}};
  const std::vector<float> q = quarter_turn();
  animate(gltf, 0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, q[0], q[1], q[2], q[3]});
  animate(gltf, 1, "translation", "LINEAR", {0, 2}, {0, 0, 0, 10, 0, 0});
  const GltfFile file = file_of(gltf);
  const GltfScene scene = file.at(1.0);
  CHECK(glm::length(scene.nodes.at(1).world_from_node.translation_m - glm::dvec3(0, 5, 0)) < float_rounding);
  CHECK(glm::length(scene.scene.positions_m.at(0) - glm::dvec3(1, 4, -1)) < float_rounding);
  CHECK(file.at(0.0).scene.positions_m.at(0) == glm::dvec3(-1, -1, -1)); // no time depends on another
}

TEST_CASE("Ids stay the same while things move") {
  json gltf = one_triangle();
  gltf["nodes"] = {{{"name", "mirror"}, {"mesh", 0}}, {{"name", "wall"}, {"mesh", 0}}};
  gltf["scenes"][0]["nodes"] = {0, 1};
  animate(gltf, 0, "scale", "LINEAR", {0, 2}, {1, 1, 1, -1, 1, 1});
  const GltfFile file = file_of(gltf);
  for (const double time_s : {0.0, 1.0, 2.0}) {
    const Scene scene = file.at(time_s).scene;
    CHECK(scene.objects == std::vector<std::string>{"mirror", "wall"});
    REQUIRE(scene.triangles.size() == 2);
    CHECK(scene.triangles[1].object == 1);
    CHECK(scene.triangles[0].vertices[1] == (time_s == 2.0 ? 2u : 1u)); // the front stays in front
  }
}
