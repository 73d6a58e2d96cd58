#include "host/input/setup/extent.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <fmt/format.h>
#include <sys/stat.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

std::string error_with(const std::string &pointer, const json &value) {
  SetupFixture fixture;
  fixture.setup[json::json_pointer(pointer)] = value;
  return fixture.error();
}

std::string error_without(const std::string &pointer, const std::string &key) {
  SetupFixture fixture;
  fixture.setup[json::json_pointer(pointer)].erase(key);
  return fixture.error();
}

std::string error_of_text(const std::string &text) {
  const SetupFixture fixture;
  return input_error_of([&] { fixture.load_text(text); });
}

std::string error_of_file(const std::filesystem::path &file) {
  return input_error_of([&] { load_setup(file); });
}

} // namespace

TEST_CASE("A sensor's node that is not there is answered with cameras, an illuminator's is not") {
  SetupFixture fixture;
  fixture.sensor()["pose"] = {{"node", "Camera"}};
  CHECK_THAT(fixture.error(),
             Contains("which has no camera that a pose can name: export it with its cameras") &&
                 EndsWith("; its nodes are \"object\""));
  fixture.scene["nodes"].push_back({{"name", "View"}, {"camera", 0}});
  fixture.scene["scenes"][0]["nodes"].push_back(1);
  CHECK_THAT(fixture.error(), EndsWith("; expected \"object\" or \"View\""));
  fixture.setup["sensors"][0].erase("pose");
  fixture.scene["nodes"].erase(1);
  fixture.scene["scenes"][0]["nodes"].erase(1);
  fixture.illuminator()["pose"] = {{"node", "Lamp"}};
  CHECK_THAT(fixture.error(), EndsWith("; expected \"object\""));
}

TEST_CASE("Setups that are no files") {
  const TemporaryFolder folder;
  CHECK_THAT(error_of_file(folder.path() / "absent.json"), EndsWith("absent.json: no such file"));
  CHECK_THAT(error_of_file(folder.path()), EndsWith(": is a directory, expected a file"));
  const auto pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(error_of_file(pipe), EndsWith("pipe: is no regular file"));
  CHECK_THAT(error_of_file("/dev/zero"), EndsWith("/dev/zero: is no regular file"));
  CHECK_THAT(error_of_file(folder.write("huge.json", std::string(5u << 20, ' '))),
             Contains("expected at most 4194304"));
}

TEST_CASE("Setups that are no JSON name line and column") {
  CHECK_THAT(error_of_text("{\n  \"scene\": \"a.gltf\",\n  oops\n}"),
             Contains("setup.json:3:3: not valid JSON"));
  CHECK_THAT(error_of_text(R"({"scene": "a", "scene": "b"})"),
             EndsWith("setup.json:1:16: key \"scene\" appears twice, first in line 1"));
  CHECK_THAT(error_of_text(R"({"sensors": [{"modulation_hz": [NaN]}]})"),
             Contains("setup.json:1:33: not valid JSON"));
  CHECK_THAT(error_of_text(std::string(20'000, '[')), Contains("nested too deep"));
}

TEST_CASE("Unknown and missing keys are named") {
  CHECK_THAT(error_with("/colour", 1),
             Contains("setup.json:1:2: unknown key \"colour\"; expected \"$schema\", \"backscatter\", "));
  CHECK_THAT(error_with("/sensors/0/focal_lenght_m", 1),
             EndsWith("/sensors/0: unknown key \"focal_lenght_m\", did you mean \"focal_length_m\"?"));
  CHECK_THAT(error_with("/sensors/0/pose", {{"nodee", "x"}}),
             EndsWith("/sensors/0/pose: unknown key \"nodee\", did you mean \"node\"?"));
  CHECK_THAT(error_with("/sensors/0/pose", {{"node", "x"}, {"up", {0, 1, 0}}}),
             EndsWith("/sensors/0/pose: unknown key \"up\"; expected \"node\""));
  CHECK_THAT(error_with("/sensors/0/pose", {{"node", "x"}, {"position_m", {1, 2, "x"}}}),
             EndsWith("/sensors/0/pose: unknown key \"position_m\"; expected \"node\""));
  CHECK_THAT(error_with("/sensors/0/pose", {{"sensor", "pmd"}}),
             Contains("/sensors/0/pose: unknown key \"sensor\"; "));
  CHECK_THAT(error_with("/illuminators/0/diodes/rings/0/radius", 1),
             EndsWith("/diodes/rings/0: unknown key \"radius\", expected \"radius_m\", in metres"));
  CHECK_THAT(error_without("", "scene"), EndsWith("setup.json:1:1: missing key \"scene\""));
  CHECK_THAT(error_without("/sensors/0", "modulation_hz"),
             EndsWith("/sensors/0: missing key \"modulation_hz\""));
  CHECK_THAT(error_without("/illuminators/0", "diodes"), EndsWith("/illuminators/0: missing key \"diodes\""));
}

TEST_CASE("Wrong types and values say what was expected", "[smoke]") {
  CHECK_THAT(error_of_text("[]"), EndsWith("setup.json:1:1: expected an object, found an array of 0"));
  CHECK_THAT(error_with("/backscatter", "mirror"),
             EndsWith("/backscatter: expected \"lambert\" or \"constant\", found \"mirror\""));
  CHECK_THAT(error_with("/shadows", "on"),
             EndsWith(" /shadows: expected \"auto\" or \"off\", found \"on\", did you mean \"auto\"?"));
  CHECK_THAT(error_with("/shadows", true), EndsWith("/shadows: expected \"auto\" or \"off\", found true"));
  CHECK_THAT(error_with("/sensors", json::array()),
             EndsWith("/sensors: expected an array of 1 to 64, each an object, found an array of 0"));
  CHECK_THAT(error_with("/sensors/0/resolution/0", 0),
             EndsWith("/sensors/0/resolution/0: expected an integer from 1 to 8192, found 0"));
  CHECK_THAT(error_with("/sensors/0/resolution/1", 100000),
             EndsWith("/resolution/1: expected an integer from 1 to 8192, found 100000"));
  CHECK_THAT(error_with("/sensors/0/resolution", {640}),
             Contains("/resolution: expected an array of 2, each an integer"));
  CHECK_THAT(error_with("/sensors/0/pixel_pitch_m/0", -45e-6),
             EndsWith("/pixel_pitch_m/0: expected a number from 1e-09 to 1000, found -4.5e-05"));
  CHECK_THAT(error_with("/sensors/0/focal_length_m", "long"),
             EndsWith("/focal_length_m: expected a number from 1e-09 to 1000, found \"long\""));
  CHECK_THAT(error_with("/sensors/0/focus_distance_m", "far"),
             Contains("/focus_distance_m: expected a number above 0 and at most 1000000000000, or null"));
  CHECK_THAT(error_with("/sensors/0/modulation_hz/0", 0),
             EndsWith("/modulation_hz/0: expected a number from 1 to 1000000000000, found 0"));
  CHECK_THAT(error_with("/sensors/0/modulation_hz", 20e6), Contains("/modulation_hz: expected an array"));
  CHECK_THAT(error_with("/sensors/0/samples", 17),
             EndsWith("/samples: expected an integer from 1 to 16, found 17"));
  CHECK_THAT(error_with("/sensors/0/samples", 2.5), Contains("/samples: expected an integer from 1 to 16"));
  CHECK_THAT(error_with("/sensors/0/name", "../pmd"),
             Contains("/sensors/0/name: expected a name of up to 64 letters"));
  CHECK_THAT(error_with("/sensors/0/name", std::string(1'000'000, 'a')),
             Contains("/sensors/0/name: expected a name"));
  CHECK_THAT(error_with("/sensors/0/pose", "here"),
             Contains("/sensors/0/pose: expected {\"node\"}, {\"position_m\""));
  CHECK_THAT(error_with("/sensors/0/pose", {{"position_m", {0, 0, "x"}}, {"look_at_m", {0, 0, 1}}}),
             Contains("/pose/position_m/2: expected a number from -1000000000 to 1000000000, found \"x\""));
  CHECK_THAT(error_with("/illuminators/0/diodes", "none"),
             Contains("/diodes: expected \"monostatic\", {\"rings\"} or {\"file\"}"));
  CHECK_THAT(error_with("/illuminators/0/diodes/rings/0/count", 0),
             Contains("/rings/0/count: expected an integer from 1"));
  CHECK_THAT(error_with("/illuminators/0/intensity_w_sr", -1),
             Contains("/intensity_w_sr: expected a number from 0 to 1e+30, found -1"));
  CHECK_THAT(error_with("/illuminators/0/pattern", {{"isotropic", false}}),
             Contains("/pattern/isotropic: expected true, found false"));
}

TEST_CASE("Values that contradict each other") {
  CHECK_THAT(error_with("/sensors/0/focus_distance_m", 0.009),
             EndsWith("/sensors/0/focus_distance_m: expected more than the focal length of 0.01 m"));
  CHECK_THAT(error_with("/sensors/0/pose", {{"position_m", {1, 2, 3}}, {"look_at_m", {1, 2, 3}}}),
             EndsWith("/sensors/0/pose/look_at_m: expected a point other than position_m, found the same"));
  CHECK_THAT(error_with("/sensors/0/pose", {{"position_m", {0, 0, 0}}, {"look_at_m", {0, -5, 0}}}),
             EndsWith("/sensors/0/pose/up: expected a direction across the view, found one along it"));
  CHECK_THAT(
      error_with("/sensors/0/pose", {{"position_m", {0, 0, 0}}, {"look_at_m", {1, 0, 0}}, {"up", {0, 0, 0}}}),
      EndsWith("/sensors/0/pose/up: expected a direction, found zero"));
  CHECK_THAT(error_with("/sensors/0/pose", {{"node", "Camera"}}),
             Contains("/sensors/0/pose/node: no node \"Camera\" in"));
  CHECK_THAT(error_with("/illuminators/0/pose", {{"sensor", "pmf"}}),
             EndsWith("/illuminators/0/pose/sensor: no sensor \"pmf\" in this setup, did you mean \"pmd\"?"));
  CHECK_THAT(
      error_with("/illuminators/0/diodes",
                 {{"rings", {{{"radius_m", 0.1}, {"count", 8}, {"active_deg", {1, 2}}}}}}),
      EndsWith("/illuminators/0/diodes/rings: expected at least one diode, active_deg switches all off"));
  CHECK_THAT(error_with("/illuminators/0/diodes/rings",
                        {{{"radius_m", 0.1}, {"count", 60000}}, {{"radius_m", 0.2}, {"count", 60000}}}),
             EndsWith("/diodes/rings/1: expected at most 100000 diodes in all rings"));
}

TEST_CASE("Rings that list too much are refused, even if they are off") {
  SetupFixture fixture;
  const auto list = [&](int dark) {
    fixture.illuminator()["diodes"]["rings"] = {{{"radius_m", 0.1}, {"count", 100'000}}};
    for (int i = 0; i < dark; ++i)
      fixture.illuminator()["diodes"]["rings"].push_back(
          {{"radius_m", 0.1}, {"count", 100'000}, {"active_deg", {0, 0}}});
  };
  list(9);
  CHECK(fixture.load().start.illuminators[0].diodes.size() == 100'000);
  list(10);
  CHECK_THAT(fixture.error(),
             EndsWith("/diodes/rings/10/count: expected at most 1000000 diodes in all rings, on or off"));
}

TEST_CASE("Rings of all illuminators together have a limit") {
  SetupFixture fixture;
  const json dark{{"radius_m", 0.1}, {"count", 100'000}, {"active_deg", {0, 0}}};
  fixture.illuminator()["diodes"]["rings"] = {{{"radius_m", 0.1}, {"count", 8}}};
  for (int i = 0; i < 5; ++i)
    fixture.illuminator()["diodes"]["rings"].push_back(dark);
  json second = fixture.illuminator();
  second["name"] = "second";
  fixture.setup["illuminators"].push_back(second);
  CHECK_THAT(fixture.error(),
             EndsWith("/illuminators/1/diodes/rings/5/count: expected at most 1000000 diodes in "
                      "all rings, on or off"));
}

TEST_CASE("A table of diodes that several illuminators name is the same for each") {
  SetupFixture fixture;
  fixture.folder.write(
      "diodes.csv",
      "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n0.1,0,0,0,0,1,1,1\n-0.1,0,0,0,0,1,1,1\n");
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  json second = fixture.illuminator();
  second["name"] = "second";
  second["intensity_w_sr"] = 3.0;
  fixture.setup["illuminators"].push_back(second);
  const Setup setup = fixture.load();
  REQUIRE(setup.start.illuminators.size() == 2);
  CHECK(setup.start.illuminators[0].diodes.size() == 2);
  CHECK(setup.start.illuminators[1].diodes.at(1).position_m ==
        setup.start.illuminators[0].diodes.at(1).position_m);
  CHECK(setup.start.illuminators[1].diodes.at(1).intensity_w_sr ==
        3.0 * setup.start.illuminators[0].diodes.at(1).intensity_w_sr);
}

TEST_CASE("Lists, objects and values of a setup have limits") {
  SetupFixture fixture;
  fixture.sensor()["pose"] = {{"sensor", "pmd"}, {"chain", json::array()}};
  for (std::size_t i = 0; i < max_setup_entries + 1; ++i)
    fixture.sensor()["pose"]["chain"].push_back(1);
  CHECK_THAT(fixture.error(), EndsWith("/sensors/0/pose/chain: expected at most 4096 entries, found 4097"));

  fixture.sensor().erase("pose");
  for (std::size_t i = 0; i < max_setup_entries + 1; ++i)
    fixture.setup["nodes"][fmt::format("n{}", i)] = nullptr;
  CHECK_THAT(fixture.error(), EndsWith("/nodes: expected at most 4096 entries, found 4097"));

  fixture.setup["nodes"] = json::object();
  for (std::size_t i = 0; i < 17; ++i)
    fixture.setup["nodes"][fmt::format("n{}", i)] = json::array_t(max_setup_entries, 0);
  CHECK_THAT(fixture.error(), Contains("expected at most 65536 values, found 69672"));
}

TEST_CASE("Nodes that are no place for a camera") {
  SetupFixture fixture;
  fixture.sensor()["pose"] = {{"node", "object"}};
  fixture.scene["nodes"][0]["scale"] = {-1, 1, 1};
  CHECK_THAT(fixture.error(),
             EndsWith("/sensors/0/pose/node: the transform of node \"object\" is mirrored or singular"));
  fixture.scene["nodes"][0]["scale"] = {1, 0, 1};
  CHECK_THAT(fixture.error(), EndsWith("is mirrored or singular"));
  fixture.scene["nodes"] = {{{"name", "object"}}, {{"name", "object"}}};
  fixture.scene["scenes"][0]["nodes"] = {0, 1};
  CHECK_THAT(fixture.error(), Contains("/sensors/0/pose/node: more than one node \"object\" in"));
}

TEST_CASE("Files that a setup names") {
  CHECK_THAT(error_with("/scene", "absent.gltf"),
             Contains("setup.json:1:") && Contains(": /scene: ") && Contains("absent.gltf\": no such file"));
  CHECK_THAT(error_with("/scene", "."), Contains("setup.json:1:") && Contains(": /scene: ") &&
                                            EndsWith("is a directory, expected a file"));
  CHECK_THAT(error_with("/scene", ""), Contains("/scene: expected a string"));
  CHECK_THAT(error_with("/illuminators/0/diodes", {{"file", "absent.csv"}}),
             Contains(": /illuminators/0/diodes/file: ") && Contains("absent.csv\": no such file"));
  SetupFixture fixture;
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  fixture.illuminator()["pattern"] = {{"isotropic", true}};
  CHECK_THAT(
      fixture.error(),
      EndsWith(
          "/illuminators/0/pattern: expected none beside a diode file, which has its own; remove it (or by "
          "--set illuminators/0/pattern=null)"));
  fixture.illuminator().erase("pattern");
  fixture.folder.write("diodes.csv", "x_m\n1\n");
  CHECK_THAT(fixture.error(), Contains("diodes.csv:1: missing columns y_m, z_m"));
}
