// Sensors and illuminators on nodes that move.

#include "tests/host/input/gltf/moving_gltf.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// The object, and a camera at (0, 0, 0) that moves by 4 m along x and looks to -x from 1 s on.
struct MovingCamera : SetupFixture {
  MovingCamera() {
    scene["nodes"].push_back({{"name", "camera"}});
    scene["scenes"][0]["nodes"].push_back(1);
    sensor()["pose"] = {{"node", "camera"}};
    animate(scene, 1, "translation", "LINEAR", {0, 2}, {0, 0, 0, 4, 0, 0});
    const float half = std::sqrt(0.5f);
    animate(scene, 1, "rotation", "STEP", {0, 1}, {0, 0, 0, 1, 0, half, 0, half});
  }
};

} // namespace

TEST_CASE("A setup without motion is the same at all times") {
  const Setup setup = SetupFixture().load();
  CHECK_FALSE(setup.motion);
  CHECK(setup.at(7.0).scene.positions_m == setup.start.scene.positions_m);
}

TEST_CASE("Sensors and the light in their frames follow their nodes") {
  const Setup setup = MovingCamera().load();
  REQUIRE(setup.motion);
  CHECK(setup.start.sensors[0].world_from_camera.translation_m == glm::dvec3(0, 0, 0));
  const Instant instant = setup.at(1.5);
  const Pose pose = instant.sensors.at(0).world_from_camera;
  CHECK(pose.translation_m == glm::dvec3(3, 0, 0));
  CHECK(glm::length(pose.rotation[2] - glm::dvec3(-1, 0, 0)) < 1e-6);
  CHECK(instant.sensors[0].resolution == glm::uvec2(64, 48));
  CHECK(instant.scene.positions_m == setup.start.scene.positions_m);
  const Illuminator &light = instant.illuminators.at(0);
  CHECK(light.world_from_illuminator.translation_m == pose.translation_m);
  CHECK(light.world_from_illuminator.rotation == pose.rotation);
  CHECK(light.diodes.size() == 8);
}

TEST_CASE("Illuminators follow their own nodes") {
  MovingCamera fixture;
  fixture.sensor().erase("pose");
  fixture.illuminator()["pose"] = {{"node", "camera"}};
  const Instant instant = fixture.load().at(0.5);
  CHECK(instant.sensors.at(0).world_from_camera.translation_m == glm::dvec3(0, 0, 0));
  CHECK(instant.illuminators.at(0).world_from_illuminator.translation_m == glm::dvec3(1, 0, 0));
}

TEST_CASE("The scene moves past what stands still") {
  SetupFixture fixture;
  animate(fixture.scene, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, -1});
  const Setup setup = fixture.load();
  CHECK(setup.at(0.25).scene.positions_m.at(0) == glm::dvec3(-1, -1, -1.25));
  CHECK(setup.at(-1.0).scene.positions_m.at(0) == glm::dvec3(-1, -1, -1));
}

TEST_CASE("A camera that is mirrored on its way is refused when it is") {
  MovingCamera fixture;
  animate(fixture.scene, 1, "scale", "LINEAR", {0, 2}, {1, 1, 1, -1, 1, 1});
  const Setup setup = fixture.load();
  CHECK_NOTHROW(setup.at(0.5));
  CHECK_THAT(input_error_of([&] { setup.at(1.5); }),
             EndsWith(" /sensors/0/pose/node: the transform of node \"camera\" is mirrored or "
                      "singular, at 1.5 s"));
}
