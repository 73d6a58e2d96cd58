// Poses as people have them: quaternions, OpenCV's vectors, inverses, and chains from a robot's base to its
// camera.

#include "tests/host/input/setup/setup_fixture.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;
using nlohmann::json;
using test::SetupFixture;

namespace {

Pose pose_of(const json &pose) {
  SetupFixture fixture;
  fixture.sensor()["pose"] = pose;
  return fixture.load().start.sensors[0].world_from_camera;
}

std::string refusal_of(const json &pose) {
  return test::input_error_of([&] { pose_of(pose); });
}

void check_same(const Pose &got, const Pose &expected) {
  CHECK(glm::distance(got.translation_m, expected.translation_m) < 1e-12);
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
    CHECK(glm::distance(got.direction(axis), expected.direction(axis)) < 1e-12);
}

// A quarter turn about z, and a way.
const json turned_rows{{0, -1, 0, 1}, {1, 0, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}};
const Pose turned{glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1), {1, 2, 3}};

} // namespace

TEST_CASE("A quaternion of any length turns as its matrix does") {
  check_same(pose_of({{"position_m", {1, 2, 3}}, {"quaternion_xyzw", {0, 0, 5, 5}}}), turned);
  CHECK_THAT(refusal_of({{"position_m", {1, 2, 3}}, {"quaternion_xyzw", {0, 0, 0, 0}}}),
             Catch::EndsWith("/sensors/0/pose/quaternion_xyzw: expected a rotation, found zero"));
}

TEST_CASE("OpenCV's extrinsics take the world to the camera") {
  const double half_pi = std::numbers::pi / 2;
  // R = quarter turn about z, t = (1, 2, 3): the camera stands at -R^T t.
  check_same(pose_of({{"rvec", {0, 0, half_pi}}, {"tvec_m", {1, 2, 3}}}), inverse(turned));
  check_same(pose_of({{"rvec", {0, 0, 0}}, {"tvec_m", {1, 2, 3}}}), Pose{glm::dmat3(1.0), {-1, -2, -3}});
}

TEST_CASE("The inverse of a pose") {
  check_same(pose_of({{"inverse", {{"matrix", turned_rows}}}}), inverse(turned));
}

TEST_CASE("A chain leads from link to link") {
  const json link{{"matrix", turned_rows}};
  check_same(pose_of({{"chain", {link}}}), turned);
  check_same(pose_of({{"chain", {link, link}}}), compose(turned, turned));
  check_same(pose_of({{"chain", {link, {{"inverse", link}}}}}), Pose());
  check_same(pose_of({{"chain", {{{"position_m", {0, 0, 1}}, {"quaternion_xyzw", {0, 0, 0, 1}}}, link}}}),
             compose(Pose{glm::dmat3(1.0), {0, 0, 1}}, turned));
}

TEST_CASE("A camera on a robot's flange moves with it") {
  SetupFixture fixture;
  fixture.folder.write("flange.tum", "0 0 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n");
  fixture.sensor()["pose"] = {{"chain", {{{"trajectory", "flange.tum"}}, {{"matrix", turned_rows}}}}};
  fixture.setup["frames"] = {{"trajectory", "flange.tum"}};
  const Setup setup = fixture.load();
  REQUIRE(setup.motion);
  check_same(setup.start.sensors[0].world_from_camera, turned);
  check_same(setup.at(1.0).sensors[0].world_from_camera, compose(Pose{glm::dmat3(1.0), {2, 0, 0}}, turned));
}

TEST_CASE("Chains that are none") {
  CHECK_THAT(refusal_of({{"chain", {{{"matrix", turned_rows}}, {{"node", "Camera"}}}}}),
             Catch::Contains("/sensors/0/pose/chain/1: expected a node as the first of the chain alone"));
  CHECK_THAT(refusal_of({{"chain", json::array()}}), Catch::Contains("/sensors/0/pose/chain"));
  CHECK_THAT(refusal_of({{"chain", {{{"sensor", "pmd"}}}}}), Catch::Contains("/sensors/0/pose/chain/0"));
  json mirrored = turned_rows;
  mirrored[0][1] = 1;
  CHECK_THAT(refusal_of({{"chain", {{{"matrix", mirrored}}}}}),
             Catch::Contains("/sensors/0/pose/chain/0/matrix: expected a rotation and a translation"));
}
