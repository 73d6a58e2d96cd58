// The findings of check on a setup, against figures worked out by hand.

#include "engine/reference/reference.h"
#include "host/report/findings.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// 40 x 30 mm of chip, 20 mm behind the lens: 90 degrees wide, 2 atan(3/4) high, 2 atan(5/4) over the
// diagonal.
Sensor wide_sensor() {
  Sensor sensor;
  sensor.resolution = {400, 300};
  sensor.pixel_pitch_m = {1e-4, 1e-4};
  sensor.focal_length_m = 0.02;
  return sensor;
}

Setup setup_of(const Sensor &sensor, const Scene &scene) {
  Setup setup;
  setup.start.scene = scene;
  setup.start.sensors = {sensor};
  setup.start.illuminators = {monostatic_illuminator(sensor.world_from_camera)};
  return setup;
}

double table_sr(const Diagram &diagram) {
  return reference::solid_angle_sr({Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>(diagram)});
}

} // namespace

TEST_CASE("a pinhole's field of view follows from chip and image distance") {
  const FieldOfView view = field_of_view(wide_sensor());
  CHECK(view.horizontal_deg == Approx(90.0));
  CHECK(view.vertical_deg == Approx(2.0 * glm::degrees(std::atan(0.75))));
  CHECK(view.diagonal_deg == Approx(2.0 * glm::degrees(std::atan(1.25))));
  CHECK(view.footprint_at_1m_m.x == Approx(1e-4 / 0.02));
  CHECK(view.darkest_corner == 1.0);
}

TEST_CASE("a shifted chip sees the angles between its own edges") {
  Sensor sensor = wide_sensor();
  sensor.chip.translation_m.x = 0.02; // from the axis to 40 mm beside it
  const FieldOfView view = field_of_view(sensor);
  CHECK(view.horizontal_deg == Approx(glm::degrees(std::atan(2.0))));
  CHECK(view.footprint_at_1m_m.x == Approx(1e-4 / 0.02)); // the plane z = 1 m is parallel to the chip
}

TEST_CASE("a fisheye sees more than 180 degrees") {
  Sensor sensor = wide_sensor();
  sensor.distortion = Fisheye{}; // the angle itself: 0.02 m from the axis is 1 rad
  sensor.pixel_pitch_m = {2e-4, 1e-4};
  const FieldOfView view = field_of_view(sensor);
  CHECK(view.horizontal_deg == Approx(glm::degrees(4.0)));
  CHECK(view.vertical_deg == Approx(glm::degrees(1.5)));
  CHECK(view.footprint_at_1m_m.x == Approx(2.0 * std::tan(0.5 * 2e-4 / 0.02)));
}

TEST_CASE("vignetting is told of the corner that it darkens most") {
  Sensor sensor = wide_sensor();
  sensor.vignetting = Vignetting::cos4;
  const double cosine = 1.0 / std::hypot(1.0, 1.25);
  CHECK(field_of_view(sensor).darkest_corner == Approx(cosine * cosine * cosine * cosine));
}

TEST_CASE("a diode shines into the integral of its diagram") {
  constexpr double pi = std::numbers::pi;
  CHECK(reference::solid_angle_sr({}) == Approx(4.0 * pi));
  CHECK(reference::solid_angle_sr({Pattern::Kind::cosine, 0.0}) == Approx(2.0 * pi)); // half of the sphere
  CHECK(reference::solid_angle_sr({Pattern::Kind::cosine, 1.0}) == Approx(pi));       // Lambert's
}

TEST_CASE("a table's integral is that of its interpolation") {
  constexpr double pi = std::numbers::pi;
  CHECK(table_sr({{0, pi / 2, pi}, {0}, {1, 1, 1}}) == Approx(4.0 * pi));
  CHECK(table_sr({{0, pi / 3}, {0}, {1, 1}}) == Approx(pi)); // a cap, 2 pi (1 - cos 60)
  // 1 - 2 theta / pi over the half-space: 2 pi (1 - 2 / pi), as the integral of theta sin(theta) is 1.
  CHECK(table_sr({{0, pi / 2}, {0}, {1, 0}}) == Approx(2.0 * pi - 4.0));
  // From 1 at phi = 0 linearly to 0 at 90 degrees, and back to 1 at a whole turn: its mean is 1/2.
  CHECK(table_sr({{pi / 2, pi}, {0, pi / 2}, {1, 0, 1, 0}}) == Approx(pi));
  // The same from where phi begins at 10 degrees and is 1 for 90 degrees: mean 1/4 + 1/2 * 3/4.
  CHECK(table_sr({{0, pi}, {pi / 18, pi / 18 + pi / 2, pi}, {1, 1, 0, 1, 1, 0}}) ==
        Approx(4.0 * pi * (0.25 + 0.5 * 0.75)));
}

TEST_CASE("a table of cos^3 in steps of a degree shines as cos^3 does, to its interpolation's error") {
  Diagram table{{}, {0}, {}};
  for (int angle = 0; angle <= 90; ++angle) {
    table.theta_rad.push_back(glm::radians(static_cast<double>(angle)));
    table.relative.push_back(std::pow(std::max(0.0, std::cos(table.theta_rad.back())), 3));
  }
  const double exact_sr = reference::solid_angle_sr({Pattern::Kind::cosine, 3.0});
  CHECK(table_sr(table) == Approx(exact_sr).epsilon(1e-4));
  CHECK(table_sr(table) != Approx(exact_sr).epsilon(1e-6));
}

TEST_CASE("check adds up the diodes of each illuminator and of all") {
  SceneBuilder builder;
  builder.add_wall({2.0, {}, {-10.0, -10.0}, {10.0, 10.0}});
  Setup setup = setup_of(wide_sensor(), builder.scene());
  Diode diode;
  diode.intensity_w_sr = 3.0;
  diode.pattern = {Pattern::Kind::diagram, 0.0,
                   std::make_shared<const Diagram>(Diagram{{0, std::numbers::pi}, {0}, {1, 1}})};
  setup.start.illuminators.push_back({"pair", {}, {diode, diode}});
  const Findings findings = findings_of(setup);
  CHECK(findings.light.diodes == 3);
  CHECK(findings.light.intensity_w_sr == 7.0);
  CHECK(findings.light.power_w == Approx(7.0 * 4.0 * std::numbers::pi));
  REQUIRE(findings.illuminators.size() == 2);
  CHECK(findings.illuminators[0].first == "monostatic");
  CHECK(findings.illuminators[1].first == "pair");
  CHECK(findings.illuminators[1].second.diodes == 2);
  CHECK(findings.illuminators[1].second.power_w == Approx(6.0 * 4.0 * std::numbers::pi));
}

TEST_CASE("check tells what can cast shadows") {
  Setup setup = setup_of(wide_sensor(), wall_at(2.0));
  CHECK(findings_of(setup).shadow_casters == 2);
  setup.start.scene.triangles.pop_back();
  CHECK(findings_of(setup).shadow_casters == 0); // nothing stands in its own light
  setup.start.scene.discs.push_back({0, 0.1, 0, 0});
  CHECK(findings_of(setup).shadow_casters == 2);
  setup.shadows = Shadows::off;
  CHECK(findings_of(setup).shadow_casters == 0);
}

TEST_CASE("several frequencies have a longer ambiguity range together") {
  CHECK(*common_ambiguity_m({20e6}) == Approx(299792458.0 / 40e6));
  CHECK(*common_ambiguity_m({20e6, 30e6}) == Approx(299792458.0 / 20e6));
  CHECK(*common_ambiguity_m({60e6, 80e6, 100e6}) == Approx(299792458.0 / 40e6));
  CHECK_FALSE(common_ambiguity_m({20e6, 1e6 / 3.0}));
}

TEST_CASE("check warns of each frequency whose ambiguity range ends before what is visible") {
  Sensor sensor = wide_sensor();
  sensor.modulation_hz = {100e6, 20e6};
  SceneBuilder builder;
  builder.add_wall({2.0, {}, {-10.0, -10.0}, {0.0, 10.0}}); // the left half of the view, beyond 1.499 m
  builder.add_wall({0.5, {}, {0.0, -10.0}, {10.0, 10.0}});  // the right half, before it
  const Setup setup = setup_of(sensor, builder.scene());
  const Findings findings = findings_of(setup);
  REQUIRE(findings.sensors.size() == 1);
  CHECK(findings.sensors[0].shares_beyond[0] == Approx(0.5));
  CHECK(findings.sensors[0].shares_beyond[1] == 0.0);
  CHECK(findings.sensors[0].visible.min_m == Approx(0.5).epsilon(1e-3));
  const std::vector<Warning> warnings = warnings_of(setup, findings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0].text, Catch::StartsWith("what is visible lies 0.5"));
  CHECK(warnings[0].code == "beyond-ambiguity");
  CHECK(warnings[0].place == "sensor pmd at 100 MHz");
  CHECK_THAT(warnings[0].text,
             Catch::Contains(" m away, 50 % of it beyond the ambiguity range of 1.49896 m: distances wrap"));
}

TEST_CASE("check tells of the diodes that point away from all that is seen") {
  const Sensor sensor = wide_sensor();
  SceneBuilder builder;
  builder.add_wall({2.0, {}, {-10.0, -10.0}, {10.0, 10.0}});
  Setup setup = setup_of(sensor, builder.scene());
  setup.file = "setup.json";
  setup.as_used["illuminators"] = {{{"name", "far"}}, {{"name", "board"}}};
  Diode diode;
  diode.pattern = {Pattern::Kind::cosine, 1.0};
  Illuminator board{"board", sensor.world_from_camera, std::vector<Diode>(12, diode)};
  const auto told = [&] {
    setup.start.illuminators = {board};
    return warnings_of(setup, findings_of(setup));
  };
  CHECK(told().empty());
  board.diodes[7].axis = {0, 0, -1};
  REQUIRE(told().size() == 1);
  CHECK(told()[0].code == "diodes-turned-away");
  CHECK(told()[0].place == "setup.json: /illuminators/1/diodes");
  CHECK(told()[0].text ==
        "1 of 12 diodes of board points away from all that is seen: number 7, counted from 0: turn "
        "its axis, +z of an illuminator is forward");
  board.diodes[2].axis = {0, -0.6, -0.8};
  CHECK_THAT(told()[0].text,
             Catch::StartsWith("2 of 12 diodes of board point away from all that is seen: numbers 2, 7"));
  const Findings findings = findings_of(setup);
  CHECK(findings.boards[0].largest_lean_deg == Approx(180.0));
  board.diodes[7].pattern = {};     // shines all around
  board.diodes[2].axis = {1, 0, 0}; // to the side: lights a half of the wall
  CHECK(told().empty());
  board.diodes[2].axis = {0, 0, -1};
  setup.bounces.count = 1; // then it may be meant to light what is behind
  CHECK(told().empty());
  setup.bounces.count = 0;
  Sensor rear = sensor; // which sees the wall behind
  rear.world_from_camera.rotation = rear.world_from_camera.rotation * glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1);
  SceneBuilder both;
  both.add_wall({2.0, {}, {-10.0, -10.0}, {10.0, 10.0}});
  setup.start.scene = both.scene();
  const std::size_t vertices = setup.start.scene.positions_m.size();
  for (std::size_t i = 0; i < vertices; ++i)
    setup.start.scene.positions_m.push_back(-setup.start.scene.positions_m[i]);
  for (std::size_t i = 0, count = setup.start.scene.triangles.size(); i < count; ++i) {
    Triangle triangle = setup.start.scene.triangles[i];
    for (std::uint32_t &vertex : triangle.vertices)
      vertex += static_cast<std::uint32_t>(vertices);
    setup.start.scene.triangles.push_back(triangle);
  }
  for (Surface &surface : setup.start.scene.surfaces)
    surface.double_sided = true;
  setup.start.sensors = {sensor, rear};
  CHECK(told().empty());
  setup.start.sensors = {sensor};
  CHECK(told().size() == 1);
  board.diodes.assign(12, board.diodes[2]); // all of them: an illuminator of its own, for something else
  CHECK(told().empty());
}

TEST_CASE("check warns of taps that take longer than the frames leave them") {
  Sensor sensor = wide_sensor();
  sensor.modulation_hz = {20e6, 30e6};
  sensor.tap_interval_s = 2.5e-3; // 8 of them are the 20 ms of a frame
  Setup setup = setup_of(sensor, wall_at(2.0));
  setup.frames = {0.0, 50.0, 2};
  CHECK(warnings_of(setup, findings_of(setup)).empty());
  setup.frames.rate_hz = 51.0;
  const std::vector<Warning> warnings = warnings_of(setup, findings_of(setup));
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0].text, Catch::StartsWith("its taps take 0.02 s, longer than the 0.0196078 s"));
  setup.frames.count = 1;
  CHECK(warnings_of(setup, findings_of(setup)).empty());
}
