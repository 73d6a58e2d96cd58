// What comes later is refused by name, never ignored.

#include "tests/host/input/setup/setup_fixture.h"

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

std::string scene_error(const std::string &pointer, const json &value) {
  SetupFixture fixture;
  fixture.scene[json::json_pointer(pointer)] = value;
  return fixture.error();
}

} // namespace

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
  for (int lines = 1; lines <= 3; ++lines)
    CHECK_THAT(scene_error("/meshes/0/primitives/0/mode", lines), Contains("/mode: lines are not supported"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/targets", {{{"POSITION", 0}}}),
             Contains("morph targets are not"));
  CHECK_THAT(scene_error("/accessors/0/componentType", 5122),
             EndsWith("/accessors/0/componentType: 5122 is not allowed for POSITION without the extension "
                      "KHR_mesh_quantization"));
}
