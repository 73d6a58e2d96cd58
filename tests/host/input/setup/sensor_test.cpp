// Lens, chip and modulation of a setup's sensors.

#include "tests/host/input/setup/setup_fixture.h"

#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

Setup setup_with(const json &keys) {
  SetupFixture fixture;
  fixture.sensor().update(keys);
  return fixture.load();
}

Sensor sensor_with(const json &keys) { return setup_with(keys).start.sensors.at(0); }

std::string error_with(const json &keys) {
  SetupFixture fixture;
  fixture.sensor().update(keys);
  return fixture.error();
}

// A second sensor beside the fixture's, of the name given.
json second_sensor(SetupFixture &fixture, const std::string &name) {
  json sensor = fixture.sensor();
  sensor["name"] = name;
  return sensor;
}

} // namespace

TEST_CASE("Without a word about it a sensor has a pinhole, a nominal chip and a sine") {
  const Sensor sensor = sensor_with(json::object());
  CHECK(sensor.fill_factor == glm::dvec2(1.0));
  CHECK(std::holds_alternative<std::monostate>(sensor.distortion));
  CHECK(sensor.chip.is_nominal());
  CHECK(sensor.vignetting == Vignetting::none);
  CHECK(sensor.waveform.kind == Waveform::Kind::sine);
  CHECK(sensor.taps == 4);
}

TEST_CASE("Brown-Conrady's coefficients are used by name") {
  const Sensor sensor =
      sensor_with({{"distortion", {{"k1", 0.01}, {"k2", 0.02}, {"p1", 0.003}, {"p2", 0.004}, {"k3", 0.05}}}});
  const auto &d = std::get<BrownConrady>(sensor.distortion);
  CHECK(d.k1 == 0.01);
  CHECK(d.k2 == 0.02);
  CHECK(d.p1 == 0.003);
  CHECK(d.p2 == 0.004);
  CHECK(d.k3 == 0.05);
  const Sensor one = sensor_with({{"distortion", {{"model", "brown"}, {"k3", 0.5}}}});
  CHECK(std::get<BrownConrady>(one.distortion).k3 == 0.5);
}

TEST_CASE("Brown-Conrady with zeros is no distortion, a fisheye with zeros is one") {
  CHECK(std::holds_alternative<std::monostate>(
      sensor_with({{"distortion", {{"model", "brown"}, {"k1", 0}, {"p2", 0.0}}}}).distortion));
  const Sensor fisheye = sensor_with({{"distortion", {{"model", "fisheye"}}}});
  CHECK(std::get<Fisheye>(fisheye.distortion).k1 == 0.0);
}

TEST_CASE("The fisheye's coefficients are used by name, and its defaults are stated") {
  const Setup setup = setup_with({{"distortion", {{"model", "fisheye"}, {"k1", 0.1}, {"k4", -0.2}}}});
  const auto &d = std::get<Fisheye>(setup.start.sensors[0].distortion);
  CHECK(d.k1 == 0.1);
  CHECK(d.k2 == 0.0);
  CHECK(d.k3 == 0.0);
  CHECK(d.k4 == -0.2);
  CHECK(json(setup.as_used["sensors"][0]["distortion"]) ==
        json({{"model", "fisheye"}, {"k1", 0.1}, {"k2", 0}, {"k3", 0}, {"k4", -0.2}}));
  const json brown = setup_with({{"distortion", {{"k2", 0.1}}}}).as_used["sensors"][0]["distortion"];
  CHECK(brown == json({{"model", "brown"}, {"k1", 0}, {"k2", 0.1}, {"p1", 0}, {"p2", 0}, {"k3", 0}}));
}

TEST_CASE("A key of the other distortion model is named") {
  CHECK_THAT(error_with({{"distortion", {{"model", "fisheye"}, {"p1", 0}}}}),
             Contains("/sensors/0/distortion: unknown key \"p1\""));
  CHECK_THAT(error_with({{"distortion", {{"model", "fisheye"}, {"p1", "x"}}}}),
             Contains("/sensors/0/distortion: unknown key \"p1\""));
  CHECK_THAT(error_with({{"distortion", {{"k1", 0}, {"k4", 0}}}}),
             Contains("/sensors/0/distortion: unknown key \"k4\""));
  CHECK_THAT(error_with({{"distortion", {{"model", "brown"}, {"k5", 0}}}}),
             Contains("/sensors/0/distortion: unknown key \"k5\""));
}

TEST_CASE("What a distortion is expected to be") {
  CHECK_THAT(error_with({{"distortion", {{"model", "pinhole"}}}}),
             EndsWith("/distortion/model: expected \"brown\" or \"fisheye\", found \"pinhole\""));
  CHECK_THAT(error_with({{"distortion", {{"model", 3}, {"k1", "x"}}}}),
             EndsWith("/distortion/model: expected \"brown\" or \"fisheye\", found 3"));
  CHECK_THAT(error_with({{"distortion", {{"model", "fisheye"}, {"k2", "x"}}}}),
             EndsWith("/distortion/k2: expected a number from -1000000 to 1000000, found \"x\""));
  CHECK_THAT(error_with({{"distortion", "brown"}}),
             Contains("/distortion: expected {\"model\": \"brown\", \"k1\"") && EndsWith("found \"brown\""));
}

TEST_CASE("A distortion that folds inside the image names where") {
  // r (1 - r^2/2) rises up to r = sqrt(2/3), where it is 2/3 r = 0.5443: 54.43 pixels of 0.01 focal lengths.
  const json lens = {{"resolution", {200, 100}},
                     {"pixel_pitch_m", {1e-4, 1e-4}},
                     {"focal_length_m", 0.01},
                     {"distortion", {{"k1", -0.5}}}};
  CHECK_THAT(
      error_with(lens),
      EndsWith("/sensors/0/distortion: expected a distortion that does not fold over inside the image, or "
               "\"beyond\": \"dark\"; it does 54.43 pixels from the optical axis towards column 0, row 0"));
  json narrow = lens;
  narrow["resolution"] = {80, 60}; // half a diagonal of 50 pixels
  CHECK_NOTHROW(sensor_with(narrow));
}

TEST_CASE("The chip's angles come in degrees, its offset in metres") {
  const Sensor sensor =
      sensor_with({{"chip", {{"rotation_deg", {18, -36, 90}}, {"translation_m", {1e-4, -2e-4, 3e-4}}}}});
  const double pi = std::numbers::pi;
  CHECK(glm::length(sensor.chip.rotation_rad - glm::dvec3(pi / 10, -pi / 5, pi / 2)) < 1e-15);
  CHECK(sensor.chip.translation_m == glm::dvec3(1e-4, -2e-4, 3e-4));
  CHECK_THAT(
      error_with({{"chip", {{"rotation_deg", {0, 0}}}}}),
      EndsWith("/chip/rotation_deg: expected [alpha, beta, gamma], alpha and beta from -89 to 89, gamma "
               "from -3600 to 3600, found an array of 2"));
}

TEST_CASE("A chip that is not in front of the lens with its front to it") {
  // 64 x 48 pixels of 45 x 40 micrometres at 10 mm.
  CHECK_THAT(error_with({{"chip", {{"translation_m", {0, 0, -0.02}}}}}),
             EndsWith("/sensors/0/chip: expected the whole chip in front of the lens"));
  // The lower edge, at y = 0.96 mm, stands 0.95 mm sin 80 deg = 0.945 mm before the middle.
  const json steep = {{"chip", {{"rotation_deg", {80, 0, 0}}, {"translation_m", {0, 0, -0.0091}}}}};
  CHECK_THAT(error_with(steep), EndsWith("/sensors/0/chip: expected the whole chip in front of the lens"));
  json farther = steep;
  farther["chip"]["translation_m"][2] = -0.009;
  CHECK_NOTHROW(sensor_with(farther));
  // In front of the lens, and yet seen from its back.
  CHECK_THAT(error_with({{"chip", {{"rotation_deg", {80, 0, 0}}, {"translation_m", {0, 0.1, 0}}}}}),
             EndsWith("/sensors/0/chip: expected the front of the chip towards the lens"));
}

TEST_CASE("Fill factor, vignetting and taps") {
  const Sensor sensor = sensor_with({{"fill_factor", {0.5, 0.25}}, {"vignetting", "cos4"}, {"taps", 16}});
  CHECK(sensor.fill_factor == glm::dvec2(0.5, 0.25));
  CHECK(sensor.vignetting == Vignetting::cos4);
  CHECK(sensor.taps == 16);
  CHECK(sensor_with({{"taps", 3}}).taps == 3);
  CHECK_THAT(error_with({{"fill_factor", {1, 0}}}),
             EndsWith("/fill_factor/1: expected a number above 0 and at most 1, found 0"));
  CHECK_THAT(error_with({{"fill_factor", {1.01, 1}}}), Contains("/fill_factor/0: expected a number above 0"));
  CHECK_THAT(error_with({{"vignetting", "cos5"}}), Contains("/vignetting: expected \"none\" or \"cos4\""));
  CHECK_THAT(error_with({{"taps", 2}}), EndsWith("/taps: expected an integer from 3 to 16, found 2"));
  CHECK_THAT(error_with({{"taps", 17}}), EndsWith("/taps: expected an integer from 3 to 16, found 17"));
}

TEST_CASE("Waveforms") {
  CHECK(sensor_with({{"waveform", "square"}}).waveform.kind == Waveform::Kind::square);
  const Waveform waveform = sensor_with({{"waveform", {{"harmonics", {1, 0, -0.1}}}}}).waveform;
  CHECK(waveform.kind == Waveform::Kind::harmonics);
  CHECK(waveform.harmonics == std::vector{1.0, 0.0, -0.1});
  CHECK(sensor_with({{"waveform", {{"harmonics", std::vector(32, 1e3)}}}}).waveform.harmonics.size() == 32);
  CHECK_THAT(error_with({{"waveform", {{"harmonics", std::vector(33, 1.0)}}}}),
             Contains("/waveform/harmonics: expected an array of 1 to 32, each a number"));
  CHECK_THAT(error_with({{"waveform", {{"harmonics", json::array()}}}}),
             Contains("/waveform/harmonics: expected an array of 1 to 32"));
  CHECK_THAT(error_with({{"waveform", {{"harmonics", {0, 0.0}}}}}),
             EndsWith("/waveform/harmonics: expected at least one amplitude other than 0"));
  CHECK_THAT(error_with({{"waveform", {{"harmonics", {1001}}}}}),
             Contains("/waveform/harmonics/0: expected a number from -1000 to 1000"));
  CHECK_THAT(
      error_with({{"waveform", "sawtooth"}}),
      EndsWith(
          "/waveform: expected \"sine\", \"square\" or {\"harmonics\": [a1, a2, ...]}, found \"sawtooth\""));
}

TEST_CASE("Harmonics of which the taps show none are a warning") {
  const auto warnings = [](const json &harmonics, int taps) {
    return setup_with({{"waveform", {{"harmonics", harmonics}}}, {"taps", taps}}).warnings;
  };
  const std::vector<Warning> two = warnings({0, 1}, 5);
  REQUIRE(two.size() == 1);
  CHECK(two[0].code == "unseen-harmonics");
  CHECK_THAT(two[0].place, EndsWith("setup.json: /sensors/0/waveform"));
  CHECK(two[0].text == "sensor pmd: none of its harmonics shows in 5 taps (only number 1, 4, 6, 9 ... do): "
                       "amplitudes will be 0; take more taps or other harmonics");
  CHECK(warnings({0, 1, -2, 0, 3, 0, 4}, 5).size() == 1);
  CHECK(warnings({0, 0, 1}, 3).size() == 1);
  for (const json &seen :
       {json::array({1}), json{0, 0, 0, 0.1}, json{0, 1, 0, 0, 0, 0.1}, json{0, 0, 0, 0, 0, 0, 0, 0, 1}})
    CHECK(warnings(seen, 5).empty());
  CHECK(warnings({0, 1}, 3).empty()); // 3 taps show harmonic 2, as harmonic -1
  for (int taps = 3; taps <= 16; ++taps)
    for (const char *waveform : {"sine", "square"})
      CHECK(setup_with({{"waveform", waveform}, {"taps", taps}}).warnings.empty());
}

TEST_CASE("A warning of harmonics names its sensor") {
  SetupFixture fixture;
  json left = second_sensor(fixture, "left");
  left["waveform"] = {{"harmonics", {0, 1}}};
  fixture.setup["sensors"].push_back(left);
  const Setup setup = fixture.load();
  REQUIRE(setup.warnings.size() == 1);
  CHECK_THAT(setup.warnings[0].text,
             Catch::StartsWith("sensor left: none of its harmonics shows in 4 taps "));
}

TEST_CASE("Several frequencies, each within the waveform's reach") {
  CHECK(sensor_with({{"modulation_hz", {20e6, 30e6, 20e6}}}).modulation_hz == std::vector{20e6, 30e6, 20e6});
  CHECK(sensor_with({{"modulation_hz", std::vector(16, 1.0)}}).modulation_hz.size() == 16);
  CHECK_THAT(error_with({{"modulation_hz", std::vector(17, 1.0)}}),
             Contains("/modulation_hz: expected an array of 1 to 16"));
  const json third = {{"harmonics", {1, 0, 0.1}}};
  CHECK_NOTHROW(sensor_with({{"modulation_hz", {1e6, 3.3e11}}, {"waveform", third}}));
  CHECK_THAT(
      error_with({{"modulation_hz", {1e6, 5e11}}, {"waveform", third}}),
      EndsWith("/sensors/0/modulation_hz/1: expected harmonic 3 of the waveform within 1000000000000 Hz, "
               "found 1500000000000 Hz"));
}

TEST_CASE("Several sensors have names of their own, and the light stands in any one's frame") {
  SetupFixture fixture;
  json left = second_sensor(fixture, "left");
  left["pose"] = {{"position_m", {-1, 2, 3}}, {"look_at_m", {0, 2, 3}}};
  left["modulation_hz"] = {10e6, 40e6};
  fixture.setup["sensors"].push_back(left);
  const Setup setup = fixture.load();
  REQUIRE(setup.start.sensors.size() == 2);
  CHECK(setup.start.sensors[1].name == "left");
  CHECK(setup.start.sensors[1].modulation_hz.size() == 2);
  CHECK(setup.start.sensors[0].modulation_hz.size() == 1);
  CHECK(setup.start.illuminators[0].world_from_illuminator.translation_m == glm::dvec3(0.0));
  CHECK(setup.as_used["illuminators"][0]["pose"] == json({{"sensor", "pmd"}}));
  CHECK(setup.as_used["sensors"][1]["taps"] == 4);
  fixture.illuminator()["pose"] = {{"sensor", "left"}};
  CHECK(fixture.load().start.illuminators[0].world_from_illuminator.translation_m == glm::dvec3(-1, 2, 3));
}

TEST_CASE("A doubled name of a sensor, and too many sensors") {
  SetupFixture fixture;
  fixture.setup["sensors"].push_back(second_sensor(fixture, "pmd"));
  CHECK_THAT(fixture.error(),
             EndsWith("/sensors/1/name: expected a name that no other sensor has, found \"pmd\""));
  for (std::size_t i = 1; i < 64; ++i)
    fixture.setup["sensors"][i] = second_sensor(fixture, "pmd" + std::to_string(i));
  CHECK(fixture.load().start.sensors.size() == 64);
  fixture.setup["sensors"].push_back(second_sensor(fixture, "last"));
  CHECK_THAT(fixture.error(), Contains("/sensors: expected an array of 1 to 64"));
}

TEST_CASE("A fault of a later sensor is told at its place") {
  SetupFixture fixture;
  json second = second_sensor(fixture, "second");
  second["distortion"] = {{"k1", -1000}};
  fixture.setup["sensors"].push_back(second);
  CHECK_THAT(fixture.error(),
             Contains("/sensors/1/distortion: expected a distortion that does not fold over"));
}
