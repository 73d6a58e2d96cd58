// What check finds in a setup, against figures worked out by hand.

#include "host/commands/findings.h"
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

TEST_CASE("a diode's power is its intensity over all directions") {
  Diode diode;
  diode.intensity_w_sr = 3.0;
  CHECK(diode_power_w(diode) == Approx(3.0 * 4.0 * std::numbers::pi));
  diode.pattern = {Pattern::Kind::cosine, 0.0}; // half of the sphere
  CHECK(diode_power_w(diode) == Approx(3.0 * 2.0 * std::numbers::pi));
  diode.pattern.order = 1.0; // Lambert's
  CHECK(diode_power_w(diode) == Approx(3.0 * std::numbers::pi));
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
  CHECK(findings.sensors[0].frequencies[0].share_beyond == Approx(0.5));
  CHECK(findings.sensors[0].frequencies[1].share_beyond == 0.0);
  CHECK(findings.sensors[0].visible.min_m == Approx(0.5).epsilon(1e-3));
  const std::vector<std::string> warnings = warnings_of(findings);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::StartsWith("sensor pmd at 100 MHz: what is visible lies 0.5"));
  CHECK_THAT(warnings[0],
             Catch::EndsWith(" m away, 50 % of it beyond the ambiguity range of 1.49896 m: distances wrap"));
}

TEST_CASE("check warns of taps that take longer than the frames leave them") {
  Sensor sensor = wide_sensor();
  sensor.modulation_hz = {20e6, 30e6};
  sensor.tap_interval_s = 2.5e-3; // 8 of them are the 20 ms of a frame
  Setup setup = setup_of(sensor, wall_at(2.0));
  setup.frames = {0.0, 50.0, 2};
  CHECK(warnings_of(findings_of(setup)).empty());
  CHECK_FALSE(findings_of(setup).moves);
  setup.frames.rate_hz = 51.0;
  const std::vector<std::string> warnings = warnings_of(findings_of(setup));
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::StartsWith("sensor pmd: its taps take 0.02 s, longer than the 0.0196078 s"));
  setup.frames.count = 1;
  CHECK(warnings_of(findings_of(setup)).empty());
}
