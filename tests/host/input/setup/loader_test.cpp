#include "tests/host/input/setup/setup_fixture.h"

#include <cmath>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

// By value: a loop over it outlives a setup that is only a temporary.

std::size_t active_of_48(const json &active_deg) {
  SetupFixture fixture;
  fixture.illuminator()["diodes"]["rings"] = {{{"radius_m", 0.1}, {"count", 48}, {"active_deg", active_deg}}};
  return diodes_of(fixture.load()).size();
}

} // namespace

TEST_CASE("A sensor is what the setup says, with the contract's defaults") {
  const Setup setup = SetupFixture().load();
  REQUIRE(setup.start.sensors.size() == 1);
  const Sensor &sensor = setup.start.sensors[0];
  CHECK(sensor.name == "pmd");
  CHECK(sensor.resolution == glm::uvec2(64, 48));
  CHECK(sensor.pixel_pitch_m == glm::dvec2(45e-6, 40e-6));
  CHECK(sensor.focal_length_m == 0.01);
  CHECK(std::isinf(sensor.focus_distance_m));
  CHECK(sensor.modulation_hz == std::vector{20e6});
  CHECK(sensor.samples == 1);
  CHECK(setup.backscatter == Backscatter::lambert);
  CHECK(setup.shadows == Shadows::automatic);
  CHECK(setup.start.scene.triangles.size() == 1);
  CHECK(setup.warnings.empty());
}

TEST_CASE("Values that are given are used") {
  SetupFixture fixture;
  fixture.setup["backscatter"] = "constant";
  fixture.setup["shadows"] = "off";
  fixture.sensor()["samples"] = 16;
  fixture.sensor()["focus_distance_m"] = 0.5;
  fixture.illuminator()["pattern"] = {{"order", 2.5}};
  fixture.illuminator()["intensity_w_sr"] = 3;
  const Setup setup = fixture.load();
  CHECK(setup.backscatter == Backscatter::constant);
  CHECK(setup.shadows == Shadows::off);
  CHECK(setup.start.sensors[0].samples == 16);
  CHECK(setup.start.sensors[0].focus_distance_m == 0.5);
  CHECK(diodes_of(setup)[0].pattern.kind == Pattern::Kind::cosine);
  CHECK(diodes_of(setup)[0].pattern.order == 2.5);
  CHECK(diodes_of(setup)[0].intensity_w_sr == 3.0);
}

TEST_CASE("Samples are a number or automatic") {
  SetupFixture fixture;
  CHECK_FALSE(fixture.load().start.sensors[0].adaptive_samples);
  fixture.sensor()["samples"] = "auto";
  const Setup setup = fixture.load();
  CHECK(setup.start.sensors[0].adaptive_samples);
  CHECK(setup.start.sensors[0].samples == 4);
  CHECK(setup.as_used["sensors"][0]["samples"] == "auto");
  fixture.sensor()["samples"] = "many";
  CHECK_THAT(fixture.error(),
             Catch::Contains("/sensors/0/samples: expected ") && Catch::Contains("\"many\""));
}

TEST_CASE("Without a pose the camera looks along -Z, +Y up, and the light is with it") {
  const Setup setup = SetupFixture().load();
  const Pose &pose = setup.start.sensors[0].world_from_camera;
  CHECK(pose.point({0, 0, 2}) == glm::dvec3(0, 0, -2));
  CHECK(pose.direction({1, 0, 0}) == glm::dvec3(1, 0, 0));
  CHECK(pose.direction({0, 1, 0}) == glm::dvec3(0, -1, 0));
  CHECK(setup.start.illuminators[0].world_from_illuminator.rotation == pose.rotation);
}

TEST_CASE("A camera looks at a point") {
  SetupFixture fixture;
  fixture.sensor()["pose"] = {{"position_m", {1, 2, 3}}, {"look_at_m", {5, 2, 3}}, {"up", {7, 0, -2}}};
  fixture.illuminator()["pose"] = {{"position_m", {0, 1, 0}}, {"look_at_m", {0, 1, 1}}};
  const Setup setup = fixture.load();
  const Pose &camera = setup.start.sensors[0].world_from_camera;
  CHECK(distance(camera.point({0, 0, 4}), {5, 2, 3}) < 1e-15);
  CHECK(distance(camera.direction({0, 1, 0}), {0, 0, 1}) < 1e-15);
  CHECK(distance(camera.direction({1, 0, 0}), {0, 1, 0}) < 1e-15);
  CHECK(glm::determinant(camera.rotation) == Approx(1.0));
  const Pose &light = setup.start.illuminators[0].world_from_illuminator;
  CHECK(distance(light.direction({1, 0, 0}), {-1, 0, 0}) < 1e-15);
}

TEST_CASE("A camera sits on a node, whatever its scale") {
  SetupFixture fixture;
  const double half_turn = std::sqrt(0.5); // 90 degrees about y: -z to -x
  fixture.scene["nodes"][0] = {
      {"name", "rig"}, {"translation", {1, 0, 0}}, {"scale", {2, 2, 2}}, {"children", {1}}};
  fixture.scene["nodes"][1] = {{"name", "Camera"},
                               {"translation", {0, 0, 1}},
                               {"rotation", {0, half_turn, 0, half_turn}},
                               {"scale", {0.1, 3, 5}}};
  fixture.sensor()["pose"] = {{"node", "Camera"}};
  const Pose pose = fixture.load().start.sensors[0].world_from_camera;
  CHECK(distance(pose.translation_m, {1, 0, 2}) < 1e-15);
  CHECK(distance(pose.direction({0, 0, 1}), {-1, 0, 0}) < 1e-15);
  CHECK(distance(pose.direction({0, 1, 0}), {0, -1, 0}) < 1e-15);
  CHECK(distance(pose.direction({1, 0, 0}), {0, 0, -1}) < 1e-15);
}

TEST_CASE("Rings hold diodes at half steps from +x towards +y") {
  const Setup setup = SetupFixture().load();
  REQUIRE(diodes_of(setup).size() == 8);
  for (std::size_t k = 0; k < 8; ++k) {
    const double angle = std::numbers::pi * (static_cast<double>(k) + 0.5) / 4;
    CHECK(distance(diodes_of(setup)[k].position_m, {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0}) <
          1e-16);
    CHECK(diodes_of(setup)[k].axis == glm::dvec3(0, 0, 1));
    CHECK(diodes_of(setup)[k].pattern.kind == Pattern::Kind::isotropic);
    CHECK(diodes_of(setup)[k].intensity_w_sr == 1.0);
  }
}

TEST_CASE("Active angles count modulo 360, both ends included") {
  CHECK(active_of_48({0, 360}) == 48);
  CHECK(active_of_48({-180, 180}) == 48);
  CHECK(active_of_48({-90, 90}) == 24);
  CHECK(active_of_48({270, 450}) == 24);
  CHECK(active_of_48({270, 90}) == 24);
  CHECK(active_of_48({90, 270}) == 24);
  CHECK(active_of_48({3.75, 11.25}) == 2);
  CHECK(active_of_48({-356.25, -348.75}) == 2);
  CHECK(active_of_48({3.75, 3.75}) == 1);
  CHECK(active_of_48({3.76, 11.25}) == 1);
}

TEST_CASE("An end that is written with ten digits is included") {
  SetupFixture fixture;
  // The first of seven diodes is at 25.714285714285715 degrees.
  fixture.illuminator()["diodes"]["rings"] = {
      {{"radius_m", 0.1}, {"count", 7}, {"active_deg", {25.7142857143, 40}}}};
  CHECK(diodes_of(fixture.load()).size() == 1);
}

TEST_CASE("The half ring shines on the right") {
  SetupFixture fixture;
  fixture.illuminator()["diodes"]["rings"][0]["active_deg"] = {-90, 90};
  const Setup setup = fixture.load();
  CHECK(diodes_of(setup).size() == 4);
  for (const Diode &diode : diodes_of(setup))
    CHECK(diode.position_m.x > 0);
}

TEST_CASE("Monostatic light is one diode at the lens") {
  SetupFixture fixture;
  fixture.illuminator()["diodes"] = "monostatic";
  fixture.illuminator()["pattern"] = {{"order", 2}};
  fixture.illuminator()["intensity_w_sr"] = 5;
  const Setup setup = fixture.load();
  REQUIRE(diodes_of(setup).size() == 1);
  CHECK(diodes_of(setup)[0].position_m == glm::dvec3(0));
  CHECK(diodes_of(setup)[0].axis == glm::dvec3(0, 0, 1));
  CHECK(diodes_of(setup)[0].pattern.order == 2.0);
  CHECK(diodes_of(setup)[0].intensity_w_sr == 5.0);
}

TEST_CASE("Monostatic light may stand anywhere") {
  SetupFixture fixture;
  fixture.illuminator()["diodes"] = "monostatic";
  CHECK(fixture.load().warnings.empty());
  fixture.illuminator()["pose"] = {{"position_m", {0, 1e-3, 0}}, {"look_at_m", {1, 0, 0}}};
  const Setup setup = fixture.load();
  CHECK(setup.warnings.empty());
  CHECK(setup.start.illuminators[0].world_from_illuminator.translation_m == glm::dvec3(0, 1e-3, 0));
}

TEST_CASE("The illuminator's intensity multiplies the diode file's") {
  SetupFixture fixture;
  fixture.folder.write("diodes.csv",
                       "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n0,0.05,0,0,0,2,3,4\n");
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  fixture.illuminator()["intensity_w_sr"] = 2;
  const Setup setup = fixture.load();
  REQUIRE(diodes_of(setup).size() == 1);
  CHECK(diodes_of(setup)[0].intensity_w_sr == 6.0);
  CHECK(diodes_of(setup)[0].pattern.order == 4.0);
  CHECK_FALSE(setup.as_used["illuminators"][0].contains("pattern"));
}

TEST_CASE("An integer may be written with a fraction of zero") {
  SetupFixture fixture;
  fixture.sensor()["resolution"] = {8.0, 8};
  fixture.sensor()["samples"] = 2.0;
  fixture.sensor()["taps"] = 4.0;
  fixture.illuminator()["diodes"]["rings"][0]["count"] = 1.2e1;
  fixture.scene["accessors"][0]["count"] = 3.0;
  const Setup setup = fixture.load();
  CHECK(setup.start.sensors[0].resolution == glm::uvec2(8, 8));
  CHECK(setup.start.sensors[0].samples == 2);
  CHECK(diodes_of(setup).size() == 12);
  CHECK(setup.start.scene.triangles.size() == 1);
}

TEST_CASE("The setup as used states every default") {
  const json as_used = SetupFixture().load().as_used;
  CHECK(as_used == json::parse(R"({
    "scene": "scene.gltf",
    "nodes": {},
    "backscatter": "lambert",
    "shadows": "auto",
    "bounces": 0,
    "bounce_error": "1mm",
    "sensors": [{
      "name": "pmd",
      "resolution": [64, 48],
      "pixel_pitch_m": [45e-6, 40e-6],
      "fill_factor": [1, 1],
      "focal_length_m": 0.01,
      "focus_distance_m": null,
      "distortion": {"model": "brown", "k1": 0, "k2": 0, "p1": 0, "p2": 0, "k3": 0},
      "chip": {"rotation_deg": [0, 0, 0], "translation_m": [0, 0, 0]},
      "vignetting": "none",
      "pose": {"position_m": [0, 0, 0], "look_at_m": [0, 0, -1], "up": [0, 1, 0]},
      "modulation_hz": [20e6],
      "waveform": "sine",
      "taps": 4,
      "tap_interval_s": 0,
      "samples": 1,
      "scatter": []
    }],
    "illuminators": [{
      "name": "ring",
      "pose": {"sensor": "pmd"},
      "diodes": {"rings": [{"radius_m": 0.1, "count": 8, "active_deg": [0, 360]}]},
      "pattern": {"isotropic": true},
      "intensity_w_sr": 1,
      "modulation_phase_deg": 0,
      "modulation_depth": 1
    }],
    "frames": {"start_s": 0, "count": 1}
  })"));
}

TEST_CASE("Frames follow one another at a rate") {
  SetupFixture fixture;
  fixture.sensor()["tap_interval_s"] = 1e-3;
  fixture.setup["frames"] = {{"start_s", -2.0}, {"rate_hz", 50}, {"count", 10}};
  const Setup setup = fixture.load();
  CHECK(setup.frames.count == 10);
  CHECK(setup.frames.time_s(0) == -2.0);
  CHECK(setup.frames.time_s(9) == Approx(-1.82));
  CHECK(setup.start.sensors[0].tap_interval_s == 1e-3);
  CHECK(setup.at(7.0).sensors[0].tap_interval_s == 1e-3);
}

TEST_CASE("A single frame needs no rate, several do") {
  SetupFixture fixture;
  fixture.setup["frames"] = {{"start_s", 3}};
  CHECK(fixture.load().frames.time_s(0) == 3.0);
  fixture.setup["frames"]["count"] = 2;
  CHECK_THAT(fixture.error(),
             Catch::EndsWith(" /frames: missing key \"rate_hz\", expected beside a count of more than 1"));
  fixture.setup["frames"]["rate_hz"] = 0;
  CHECK_THAT(fixture.error(), Catch::Contains("/frames/rate_hz: expected a number from 1e-06 to 1000000000"));
}

TEST_CASE("The setup as used is a setup") {
  SetupFixture fixture;
  const Setup first = fixture.load();
  CHECK(fixture.load_text(first.as_used.dump()).as_used == first.as_used);
}

TEST_CASE("A scene without triangles and points is a warning") {
  SetupFixture fixture;
  fixture.scene = {{"asset", {{"version", "2.0"}}}};
  const Setup setup = fixture.load();
  CHECK(setup.start.scene.triangles.empty());
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0].text, Catch::Contains("the scene has neither triangles nor points"));
}
