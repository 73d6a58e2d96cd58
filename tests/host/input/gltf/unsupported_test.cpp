// Features of glTF that are not supported are refused by name, never ignored.

#include "host/input/gltf/extensions.h"
#include "host/input/schema/schema_check.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <map>

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
               Contains("/extensionsRequired/1: extension \"" + std::string(name) + "\" is not supported"));
  CHECK_THAT(scene_error("/extensionsRequired", {1}), Contains("/extensionsRequired/0: expected a string"));
}

namespace {

// Calls visit(name, form) for each extension's part that the schema describes.
template <class Visit>
void for_each_part(const nlohmann::json &schema, const Visit &visit) {
  if (schema.is_object() && schema.contains("/properties/extensions/properties"_json_pointer))
    for (const auto &[name, form] : schema.at("/properties/extensions/properties"_json_pointer).items())
      visit(name, form);
  if (schema.is_structured())
    for (const auto &inner : schema)
      for_each_part(inner, visit);
}

} // namespace

TEST_CASE(
    "the schema describes the parts of extensions that are read, and whatever refers to other objects") {
  const auto schema = nlohmann::json::parse(gltf_schema_text);
  std::map<std::string, nlohmann::json> parts;
  for_each_part(schema,
                [&](const std::string &name, const nlohmann::json &form) { parts[name].merge_patch(form); });
  for (const auto &[name, form] : parts) {
    INFO(name);
    CHECK(extension_part(nlohmann::json::object(), name) == nullptr); // throws where it is not read
  }
  for (const GltfExtension &extension : gltf_extensions())
    for (const ExtensionReference &reference : extension.references) {
      INFO(extension.name << ' ' << reference.member);
      const std::string key(reference.member.substr(0, reference.member.find('/')));
      CHECK(parts[std::string(extension.name)]["properties"].contains(key));
    }
  CHECK(parts.size() == 2);
}

TEST_CASE("glTF features of later are refused by name") {
  CHECK_THAT(
      scene_error("/extensionsRequired", {"KHR_draco_mesh_compression"}),
      EndsWith("/extensionsRequired/0: extension \"KHR_draco_mesh_compression\" is not supported: export "
               "without compression (Blender: Data, Compression off), or pack with meshopt"));
  CHECK_THAT(scene_error("/extensionsRequired", {"KHR_texture_basisu"}),
             EndsWith("\"KHR_texture_basisu\" is not supported: export with PNG or JPEG textures"));
  for (int lines = 1; lines <= 3; ++lines)
    CHECK_THAT(scene_error("/meshes/0/primitives/0/mode", lines), Contains("/mode: lines are not supported"));
  CHECK_THAT(scene_error("/meshes/0/primitives/0/targets", {{{"POSITION", 0}}}),
             Contains("morph targets are not"));
  CHECK_THAT(scene_error("/accessors/0/componentType", 5122),
             EndsWith("/accessors/0/componentType: 5122 is not allowed for POSITION without the extension "
                      "KHR_mesh_quantization"));
}
