// What comes later is refused by name, never ignored.

#include "setup_fixture.h"

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

std::string setup_error(const std::string &pointer, const json &value) {
  SetupFixture fixture;
  fixture.setup[json::json_pointer(pointer)] = value;
  return fixture.error();
}

std::string scene_error(const std::string &pointer, const json &value) {
  SetupFixture fixture;
  fixture.scene[json::json_pointer(pointer)] = value;
  return fixture.error();
}

} // namespace

TEST_CASE("Shadows are refused unless switched off in writing") {
  const std::string expected =
      "setup.json: /shadows: shadows are not supported yet; write \"shadows\": \"off\"";
  CHECK_THAT(setup_error("/shadows", "auto"), EndsWith(expected));
  SetupFixture absent;
  absent.setup.erase("shadows");
  CHECK_THAT(absent.error(), EndsWith(expected));
}

TEST_CASE("Setup keys of later features are refused by name") {
  CHECK_THAT(setup_error("/sensors/0/samples", "auto"), Contains("/samples: not supported yet"));
}

TEST_CASE("Setup keys of later features are refused in every sensor") {
  SetupFixture fixture;
  json second = fixture.sensor();
  second["name"] = "second";
  second["samples"] = "auto";
  fixture.setup["sensors"].push_back(second);
  CHECK_THAT(fixture.error(), Contains("/sensors/1/samples: not supported yet"));
}

TEST_CASE("glTF features of later are refused by name") {
  CHECK_THAT(scene_error("/extensionsRequired", {"KHR_draco_mesh_compression"}),
             EndsWith("/extensionsRequired/0: extension \"KHR_draco_mesh_compression\" is not supported"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/mode", 0), Contains("/mode: points are not supported yet"));
  for (int lines = 1; lines <= 3; ++lines)
    CHECK_THAT(scene_error("/meshes/0/primitives/0/mode", lines), Contains("/mode: lines are not supported"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/attributes/COLOR_0", 0),
             Contains("vertex colours are not supported yet"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/targets", {{{"POSITION", 0}}}),
             Contains("morph targets are not"));
  CHECK_THAT(scene_error("/accessors/0/sparse", json::object()),
             EndsWith("/accessors/0/sparse: sparse accessors are not supported yet"));
  CHECK_THAT(scene_error("/accessors/0/componentType", 5122),
             Contains("quantized positions are not supported yet"));
}
