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
  CHECK_THAT(setup_error("/sensors/0/tap_interval_s", 1e-3), Contains("/tap_interval_s: not supported yet"));
  CHECK_THAT(setup_error("/sensors/0/samples", "auto"), Contains("/samples: not supported yet"));
  CHECK_THAT(setup_error("/illuminators/1", SetupFixture().illuminator()),
             Contains("/illuminators/1: several"));
  CHECK_THAT(setup_error("/illuminators/0/pattern", {{"file", "led.ies"}}),
             Contains("/pattern/file: not supported yet"));
  CHECK_THAT(setup_error("/illuminators/0/modulation_phase_deg", 90),
             Contains("/modulation_phase_deg: not supported yet"));
  CHECK_THAT(setup_error("/frames", {{"count", 2}, {"rate_hz", 50}}),
             Contains("/frames/count: not supported yet"));
  CHECK_THAT(setup_error("/frames", {{"start_s", 1}}),
             Contains("/frames/start_s: not supported yet (expected 0)"));
}

TEST_CASE("Setup keys of later features are refused in every sensor") {
  SetupFixture fixture;
  json second = fixture.sensor();
  second["name"] = "second";
  second["tap_interval_s"] = 1e-3;
  fixture.setup["sensors"].push_back(second);
  CHECK_THAT(fixture.error(), EndsWith("/sensors/1/tap_interval_s: not supported yet (expected 0)"));
}

TEST_CASE("Setup keys of later features are accepted at their defaults") {
  SetupFixture fixture;
  fixture.sensor()["tap_interval_s"] = 0.0;
  fixture.illuminator()["modulation_phase_deg"] = 0.0;
  fixture.setup["frames"] = {{"start_s", 0.0}, {"rate_hz", 50}, {"count", 1}};
  CHECK_NOTHROW(fixture.load());
}

TEST_CASE("Required extensions are those that are there, or change nothing that is simulated") {
  const auto load_requiring = [](const json &names) {
    SetupFixture fixture;
    fixture.scene["extensionsRequired"] = names;
    fixture.load();
  };
  CHECK_NOTHROW(
      load_requiring({"KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_texture_transform"}));
  CHECK_NOTHROW(load_requiring({"KHR_materials_unlit", "KHR_lights_punctual"}));
  for (const char *name :
       {"KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "KHR_materials_transmission",
        "KHR_materials_pbrSpecularGlossiness", "KHR_texture_basisu", "EXT_texture_webp", "KHR_materials"})
    CHECK_THAT(scene_error("/extensionsRequired", {"KHR_materials_unlit", name}),
               EndsWith("/extensionsRequired/1: extension \"" + std::string(name) + "\" is not supported"));
  CHECK_THAT(scene_error("/extensionsRequired", {1}), Contains("/extensionsRequired/0: expected a string"));
}

TEST_CASE("glTF features of later are refused by name") {
  CHECK_THAT(scene_error("/extensionsRequired", {"KHR_draco_mesh_compression"}),
             EndsWith("/extensionsRequired/0: extension \"KHR_draco_mesh_compression\" is not supported"));
  CHECK_THAT(scene_error("/animations", json::array({json::object()})),
             EndsWith("/animations: animations are not supported yet"));
  CHECK_THAT(scene_error("/nodes/0/skin", 0), EndsWith("/nodes/0/skin: skins are not supported yet"));
  for (int lines = 1; lines <= 3; ++lines)
    CHECK_THAT(scene_error("/meshes/0/primitives/0/mode", lines), Contains("/mode: lines are not supported"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/targets", {{{"POSITION", 0}}}),
             Contains("morph targets are not"));
  CHECK_THAT(scene_error("/accessors/0/componentType", 5122),
             EndsWith("/accessors/0/componentType: 5122 is not allowed for POSITION without the extension "
                      "KHR_mesh_quantization"));
  const auto material_error = [](const json &material) {
    SetupFixture fixture;
    fixture.scene["materials"] = {material};
    fixture.scene["meshes"][0]["primitives"][0]["material"] = 0;
    return fixture.error();
  };
  CHECK_THAT(material_error({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}),
             EndsWith("/materials/0/pbrMetallicRoughness/baseColorTexture: textures are not supported yet"));
  CHECK_THAT(material_error({{"alphaMode", "MASK"}}),
             Contains("/materials/0/alphaMode: MASK is not supported yet"));
  CHECK_THAT(material_error({{"alphaMode", "BLEND"}}), Contains("BLEND is not supported yet"));
}
