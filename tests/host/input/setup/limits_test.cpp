// Every number that is read has a range: its ends are accepted, what lies beyond is refused with the range.

#include "tests/host/input/setup/setup_fixture.h"

#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

constexpr double beyond = 1.0001; // times a limit: just beyond

struct Limits {
  std::string pointer;
  double lowest, highest;
};

// A good setup with one number replaced.
struct With : SetupFixture {
  With(const std::string &pointer, double value) {
    sensor()["chip"] = {{"rotation_deg", {0, 0, 0}}, {"translation_m", {0, 0, 0}}};
    sensor()["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", {0, 0, -1}}};
    illuminator()["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", {0, 0, -1}}};
    illuminator()["pattern"] = {{"order", 2}};
    setup["illuminators"].push_back({{"name", "other"}, {"diodes", "monostatic"}, {"modulation_hz", 1e6}});
    setup[json::json_pointer(pointer)] = value;
  }
};

std::string error_or_none(const std::string &pointer, double value) {
  try {
    With(pointer, value).load();
    return "";
  } catch (const Error &error) {
    return error.what();
  }
}

void check_limits(const Limits &limits) {
  INFO(limits.pointer);
  CHECK_NOTHROW(With(limits.pointer, limits.lowest).load());
  CHECK_NOTHROW(With(limits.pointer, limits.highest).load());
  const double below = limits.lowest > 0 ? limits.lowest / beyond : limits.lowest * beyond - 1e-9;
  const std::string expected = fmt::format("{}: expected a number from {} to {}, found ", limits.pointer,
                                           limits.lowest, limits.highest);
  CHECK_THAT(With(limits.pointer, below).error(), Contains(expected));
  CHECK_THAT(With(limits.pointer, limits.highest * beyond).error(), Contains(expected));
}

std::string diode_error(const std::string &row, double intensity_w_sr = 1.0) {
  SetupFixture fixture;
  fixture.folder.write("diodes.csv",
                       "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n" + row + "\n");
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  fixture.illuminator()["intensity_w_sr"] = intensity_w_sr;
  try {
    fixture.load();
    return "";
  } catch (const Error &) {
    return fixture.error();
  }
}

} // namespace

TEST_CASE("The ranges of a setup's numbers", "[smoke]") {
  check_limits({"/sensors/0/pixel_pitch_m/0", 1e-9, 1e3});
  check_limits({"/sensors/0/pixel_pitch_m/1", 1e-9, 1e3});
  check_limits({"/sensors/0/focal_length_m", 1e-9, 1e3});
  check_limits({"/sensors/0/modulation_hz/0", 1, 1e12});
  check_limits({"/sensors/0/chip/rotation_deg/2", -3600, 3600});
  check_limits({"/sensors/0/tap_interval_s", 0, 1e6});
  check_limits({"/sensors/0/pose/position_m/0", -1e9, 1e9});
  check_limits({"/sensors/0/pose/look_at_m/0", -1e9, 1e9});
  check_limits({"/illuminators/0/pose/position_m/0", -1e9, 1e9});
  check_limits({"/illuminators/0/pose/look_at_m/0", -1e9, 1e9});
  check_limits({"/illuminators/0/diodes/rings/0/radius_m", 0, 1e9});
  check_limits({"/illuminators/0/intensity_w_sr", 0, 1e30});
  check_limits({"/illuminators/0/pattern/order", 0, 1e6});
  check_limits({"/illuminators/0/modulation_phase_deg", -3.6e6, 3.6e6});
  check_limits({"/illuminators/1/modulation_hz", 1, 1e12});
  check_limits({"/frames/start_s", -1e9, 1e9});
  check_limits({"/frames/rate_hz", 1e-6, 1e9});
}

// At their ends these make no image, which is another error.
TEST_CASE("The ranges of a lens's and a chip's numbers") {
  const auto check_beyond = [](const std::string &pointer, double limit) {
    INFO(pointer);
    for (const double value : {-limit * beyond, limit * beyond})
      CHECK_THAT(
          With(pointer, value).error(),
          Contains(fmt::format("{}: expected a number from {} to {}, found ", pointer, -limit, limit)));
    for (const double value : {-limit, limit})
      CHECK(error_or_none(pointer, value).find("expected a number") == std::string::npos);
  };
  for (const char *coefficient : {"k1", "k2", "p1", "p2", "k3"})
    check_beyond(fmt::format("/sensors/0/distortion/{}", coefficient), 1e6);
  for (const char *axis : {"0", "1"})
    check_beyond(fmt::format("/sensors/0/chip/rotation_deg/{}", axis), 89);
  for (const char *axis : {"0", "1", "2"})
    check_beyond(fmt::format("/sensors/0/chip/translation_m/{}", axis), 1e3);
}

TEST_CASE("The focus distance has an upper end, or none") {
  CHECK_NOTHROW(With("/sensors/0/focus_distance_m", 1e12).load());
  CHECK_THAT(With("/sensors/0/focus_distance_m", 1e12 * beyond).error(),
             Contains("/focus_distance_m: expected a number above 0 and at most 1000000000000, found "));
}

TEST_CASE("The ranges of a diode file's numbers") {
  CHECK(diode_error("1e9,-1e9,1e9,0,0,1,1e30,1e6") == "");
  CHECK(diode_error("0,0,0,0,0,1,0,0") == "");
  const std::string position = "expected a number from -1000000000 to 1000000000, found ";
  CHECK_THAT(diode_error("1.1e9,0,0,0,0,1,1,1"), EndsWith("diodes.csv:2:1: x_m: " + position + "\"1.1e9\""));
  CHECK_THAT(diode_error("0,-1.1e9,0,0,0,1,1,1"), EndsWith("y_m: " + position + "\"-1.1e9\""));
  CHECK_THAT(diode_error("0,0,1e300,0,0,1,1,1"), EndsWith("z_m: " + position + "\"1e300\""));
  CHECK_THAT(diode_error("0,0,0,0,0,1,1.1e30,1"),
             EndsWith("intensity_w_sr: expected a number from 0 to 1e+30, found \"1.1e30\""));
  CHECK_THAT(diode_error("0,0,0,0,0,1,1,1.1e6"),
             EndsWith("pattern: expected a number from 0 to 1000000, found \"1.1e6\""));
}

TEST_CASE("An intensity and the diode file's have a product within the range") {
  CHECK(diode_error("0,0,0,0,0,1,1e10,1", 1e20) == "");
  CHECK_THAT(diode_error("0,0,0,0,0,1,1e11,1", 1e20),
             EndsWith("/illuminators/0/diodes/file: diode 0: its intensity times intensity_w_sr is 1e+31, "
                      "expected at most 1e+30 W/sr"));
}

TEST_CASE("A scene's vertices and the nodes that are used lie in the world") {
  SetupFixture fixture;
  fixture.scene["nodes"][0]["translation"] = {9.9e8, 0, 0};
  fixture.sensor()["pose"] = {{"node", "object"}};
  CHECK_NOTHROW(fixture.load());
  fixture.scene["nodes"][0]["translation"] = {0, -1.1e9, 0};
  CHECK_THAT(
      fixture.error(),
      EndsWith("scene.gltf: /meshes/0/primitives/0: vertex 0 lies outside the world, expected coordinates "
               "from -1000000000 to 1000000000 m"));
  fixture.scene["nodes"][0].erase("mesh");
  CHECK_THAT(fixture.error(),
             EndsWith("/sensors/0/pose/node: node \"object\" lies outside the world, expected "
                      "coordinates from -1000000000 to 1000000000 m"));
}
