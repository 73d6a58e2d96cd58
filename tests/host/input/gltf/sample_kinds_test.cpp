// Of each kind of file that the Khronos sample assets have, a small one of our own, with what is told of it:
// a square with the kind's feature on it.

#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

struct Kind {
  const char *name;
  const char *patch; // RFC 7396, onto the square
  // The codes of its warnings, in their order, or what the error says.
  std::vector<std::string> expected{};
};

// A square a metre before the lens, with a matt material, colours, two sets of texture coordinates and a
// texture that is loaded by nothing.
json square() {
  json gltf = document({-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1}, {0, 1, 2, 0, 2, 3}, 4);
  gltf["materials"] = json::array({{{"name", "paint"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
  json &primitive = gltf["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  const std::string colours = bytes_of(std::vector<float>(12, 0.5f));
  const std::string coordinates = bytes_of(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0});
  primitive["attributes"]["COLOR_0"] = add_accessor(gltf, colours, 5126, 4, "VEC3");
  primitive["attributes"]["TEXCOORD_0"] = add_accessor(gltf, coordinates, 5126, 4, "VEC2");
  primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"]["TEXCOORD_0"];
  gltf["textures"] = json::array({json::object()});
  return gltf;
}

// The square, patched; a member "material", "node" or "primitive" of the patch goes to the first of these.
json file_of_kind(const Kind &kind) {
  json gltf = square(), patch = json::parse(kind.patch);
  const std::vector<std::pair<const char *, json *>> parts{
      {"material", &gltf["materials"][0]},
      {"node", &gltf["nodes"][0]},
      {"primitive", &gltf["meshes"][0]["primitives"][0]}};
  for (const auto &[name, member] : parts)
    if (patch.contains(name)) {
      member->merge_patch(patch[name]);
      patch.erase(name);
    }
  gltf.merge_patch(patch);
  return gltf;
}

std::vector<std::string> told_of(const json &gltf) {
  std::vector<std::string> codes;
  const GltfFile file = file_of(gltf);
  CHECK(file.at(0).scene.shape_count() == 2);
  for (const Warning &warning : file.warnings({}))
    codes.push_back(warning.code);
  return codes;
}

// What is wholly simulated, or has no effect on a measurement.
const std::vector<Kind> plain_kinds{
    {"Triangle", R"({})"},
    {"TriangleWithoutIndices", R"({"primitive": {"indices": null, "mode": 6}})"},
    {"Box", R"({"material": {"doubleSided": true}})"},
    {"BoxVertexColors", R"({"primitive": {"attributes": {"COLOR_0": 2}}})"},
    {"MultiUVTest", R"({"primitive": {"attributes": {"TEXCOORD_1": 3, "TEXCOORD_2": 3}}})"},
    {"AlphaBlendModeTest", R"({"material": {"alphaMode": "MASK", "alphaCutoff": 0.25}})"},
    {"AlphaBlendModeTest, opaque", R"({"material": {"alphaMode": "BLEND"}})"},
    {"SimpleSparseAccessor", R"({"extensionsUsed": []})"},
    {"MeshPrimitiveModes, strips", R"({"primitive": {"indices": null, "mode": 5}})"},
    {"Unicode", R"({"node": {"name": "Куб ユニコード"}, "material": {"name": "ユニコード"}})"},
    {"XmpMetadataRoundedCube",
     R"({"extensionsUsed": ["KHR_xmp_json_ld"], "extensions": {"KHR_xmp_json_ld": {"packets": [{}]}},
         "asset": {"version": "2.0", "extensions": {"KHR_xmp_json_ld": {"packet": 0}}}})"},
    {"TextureTransformTest", R"({"extensionsUsed": ["KHR_texture_transform"]})"},
    {"MetallicFactorLeftOut", R"({"material": {"pbrMetallicRoughness": {"metallicFactor": null}}})"},
    {"EmissiveBlack", R"({"material": {"emissiveFactor": [0, 0, 0], "emissiveTexture": {"index": 0}}})"},
    {"ClearCoatTest, none",
     R"({"extensionsUsed": ["KHR_materials_clearcoat"],
         "material": {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0}}}})"},
    {"SpecularTest, none",
     R"({"material": {"extensions": {"KHR_materials_specular": {"specularFactor": 0}}}})"},
    {"Opaque, of another index", R"({"material": {"extensions": {"KHR_materials_ior": {"ior": 1.45}}}})"},
    {"IOR of glass that is written out",
     R"({"material": {"extensions": {"KHR_materials_ior": {"ior": 1.5}}}})"},
    {"BoxDraco, beside plain geometry", R"({"extensionsUsed": ["KHR_draco_mesh_compression"]})"},
    {"StainedGlassLamp's images, beside PNG", R"({"extensionsUsed": ["KHR_texture_basisu"]})"},
    {"MeshoptCubeTest, uncompressed", R"({"extensionsUsed": ["EXT_meshopt_compression"]})"},
    {"Light that no node has",
     R"({"extensionsUsed": ["KHR_lights_punctual"],
         "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}})"},
    {"Materials that nothing has",
     R"({"primitive": {"material": null}, "material": {"emissiveFactor": [1, 1, 1]}})"},
    {"AnimatedCube, still", R"({"animations": []})"},
};

const std::vector<Kind> told_kinds{
    {"MetalRoughSpheres",
     R"({"material": {"pbrMetallicRoughness": {"metallicFactor": 1}}})",
     {"gltf-metallic"}},
    {"MetalRoughSpheresNoTextures",
     R"({"material": {"pbrMetallicRoughness": {"metallicFactor": null, "roughnessFactor": 0.2}}})",
     {"gltf-metallic", "gltf-glossy"}},
    {"DamagedHelmet",
     R"({"material": {"pbrMetallicRoughness": {"metallicFactor": null,
                      "metallicRoughnessTexture": {"index": 0}}, "emissiveFactor": [1, 1, 1],
                      "emissiveTexture": {"index": 0}, "normalTexture": {"index": 0},
                      "occlusionTexture": {"index": 0}}})",
     {"gltf-metallic", "gltf-emission", "gltf-normal-map", "gltf-occlusion-map"}},
    {"WaterBottle", R"({"material": {"pbrMetallicRoughness": {"roughnessFactor": 0.1}}})", {"gltf-glossy"}},
    {"TransmissionTest",
     R"({"material": {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}})",
     {"gltf-transmission"}},
    {"DiffuseTransmissionTeacup",
     R"({"material": {"extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}}}})",
     {"gltf-transmission"}},
    {"AttenuationTest",
     R"({"material": {"extensions": {"KHR_materials_volume": {"thicknessFactor": 0.1},
                      "KHR_materials_transmission": {"transmissionFactor": 0.9}}}})",
     {"gltf-transmission", "gltf-volume"}},
    {"EmissiveStrengthTest",
     R"({"material": {"emissiveFactor": [1, 0, 0],
                      "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}}})",
     {"gltf-emission"}},
    {"EmissiveFireflies", R"({"material": {"emissiveFactor": [0, 0, 0.1]}})", {"gltf-emission"}},
    {"LightsPunctualLamp",
     R"({"extensionsUsed": ["KHR_lights_punctual"],
         "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot"}]}},
         "node": {"extensions": {"KHR_lights_punctual": {"light": 0}}}})",
     {"gltf-lights"}},
    {"DirectionalLight",
     R"({"extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}]}},
         "node": {"extensions": {"KHR_lights_punctual": {"light": 0}}}})",
     {"gltf-lights"}},
    {"NormalTangentTest", R"({"material": {"normalTexture": {"index": 0}}})", {"gltf-normal-map"}},
    {"NormalTangentMirrorTest",
     R"({"material": {"normalTexture": {"index": 0, "scale": 0.5}}})",
     {"gltf-normal-map"}},
    {"CompareAmbientOcclusion",
     R"({"material": {"occlusionTexture": {"index": 0}}})",
     {"gltf-occlusion-map"}},
    {"ClearCoatTest",
     R"({"material": {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}}})",
     {"gltf-clearcoat"}},
    {"ClearCoatCarPaint",
     R"({"material": {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}},
                      "pbrMetallicRoughness": {"metallicFactor": 0.8}}})",
     {"gltf-metallic", "gltf-clearcoat"}},
    {"SheenChair",
     R"({"material": {"extensions": {"KHR_materials_sheen": {"sheenColorFactor": [0.1, 0, 0]}}}})",
     {"gltf-sheen"}},
    {"IridescenceLamp",
     R"({"material": {"extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1}}}})",
     {"gltf-iridescence"}},
    {"AnisotropyBarnLamp",
     R"({"material": {"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}}}})",
     {"gltf-anisotropy"}},
    {"SpecularTest",
     R"({"material": {"extensions": {"KHR_materials_specular": {"specularFactor": 0.5}}}})",
     {"gltf-specular"}},
    {"SpecularSilkPouf",
     R"({"material": {"extensions": {"KHR_materials_specular": {"specularColorFactor": [1, 0.5, 1]},
                      "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}}}})",
     {"gltf-sheen", "gltf-specular"}},
    {"IORTestGrid",
     R"({"material": {"extensions": {"KHR_materials_ior": {"ior": 1.33},
                      "KHR_materials_transmission": {"transmissionFactor": 1}}}})",
     {"gltf-transmission", "gltf-ior"}},
    {"DispersionTest",
     R"({"material": {"extensions": {"KHR_materials_dispersion": {"dispersion": 0.3},
                      "KHR_materials_volume": {"thicknessFactor": 1}}}})",
     {"gltf-volume", "gltf-dispersion"}},
    {"UnlitTest", R"({"material": {"extensions": {"KHR_materials_unlit": {}}}})", {"gltf-unlit"}},
    {"SpecGlossVsMetalRough",
     R"({"material": {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 0, 0, 1]}}}})",
     {"gltf-specular-glossiness"}},
    {"MaterialsVariantsShoe",
     R"({"extensions": {"KHR_materials_variants": {"variants": [{"name": "beach"}, {"name": "street"}]}},
         "primitive": {"extensions": {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [1]}]}}}})",
     {"gltf-variants"}},
    {"AnimatedColorsCube",
     R"({"extensionsUsed": ["KHR_animation_pointer"],
         "animations": [{"samplers": [{"input": 2, "output": 2}], "channels": [{"sampler": 0, "target":
           {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/0"}}}}]}]})",
     {"gltf-animation-pointer"}},
    {"SimpleInstancing",
     R"({"node": {"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}})",
     {"gltf-instancing"}},
    {"CubeVisibility",
     R"({"node": {"extensions": {"KHR_node_visibility": {"visible": false}}}})",
     {"gltf-visibility"}},
    {"MultipleScenes", R"({"scenes": [{"nodes": [0]}, {}]})", {"gltf-scenes"}},
    {"Cameras", R"({"cameras": [{"type": "perspective"}], "node": {"camera": 0}})", {"gltf-camera"}},
    {"More vertex colours", R"({"primitive": {"attributes": {"COLOR_1": 2}}})", {"gltf-vertex-colours"}},
    {"MultipleLODs",
     R"({"extensionsUsed": ["MSFT_lod"], "node": {"extensions": {"MSFT_lod": {"ids": []}}}})",
     {"gltf-extension"}},
    {"Structural metadata",
     R"({"extensionsUsed": ["EXT_structural_metadata", "EXT_mesh_features"],
         "extensions": {"EXT_structural_metadata": {"schema": {}}},
         "primitive": {"extensions": {"EXT_mesh_features": {"featureIds": []}}}})",
     {"gltf-extension", "gltf-extension"}},
    {"Of a vendor, not listed as used",
     R"({"material": {"extensions": {"ACME_rust": {}}}})",
     {"gltf-extension"}},
    {"RigidBodies", R"({"extensionsUsed": ["KHR_physics_rigid_bodies"]})", {"gltf-extension"}},
    {"ScatteringSkull",
     R"({"material": {"extensions": {"KHR_materials_volume_scatter": {"multiscatterColor": [1, 0, 0]},
                      "KHR_materials_volume": {"thicknessFactor": 1}}}})",
     {"gltf-volume", "gltf-extension"}},
    {"ImageBasedLight", R"({"extensionsUsed": ["EXT_lights_image_based"]})", {"gltf-extension"}},
    {"Interactivity", R"({"extensions": {"KHR_interactivity": {"graphs": []}}})", {"gltf-extension"}},
};

// Without which the scene would be another.
const std::vector<Kind> refused_kinds{
    {"MorphPrimitivesTest",
     R"({"primitive": {"targets": [{"POSITION": 0}]}})",
     {"morph targets are not supported"}},
    {"AnimatedMorphCube",
     R"({"animations": [{"samplers": [{"input": 2, "output": 2}],
         "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]})",
     {"morph targets are not supported"}},
    {"MeshPrimitiveModes, lines", R"({"primitive": {"mode": 1}})", {"lines are not supported"}},
    {"MeshPrimitiveModes, points", R"({"primitive": {"mode": 0}})", {"points without a size"}},
    {"AlphaBlendModeTest, blended",
     R"({"material": {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}})",
     {"BLEND is not supported"}},
    {"BoxDraco", R"({"extensionsRequired": ["KHR_draco_mesh_compression"]})", {"is not supported"}},
    {"GlassVaseFlowers", R"({"extensionsRequired": ["KHR_materials_transmission"]})", {"is not supported"}},
    {"Basisu", R"({"extensionsRequired": ["KHR_texture_basisu"]})", {"is not supported"}},
};

} // namespace

TEST_CASE("Of every kind of sample exactly what is ignored is told") {
  CHECK(plain_kinds.size() + told_kinds.size() + refused_kinds.size() >= 60);
  CHECK(told_kinds.size() + refused_kinds.size() >= 40);
  for (const std::vector<Kind> *kinds : {&plain_kinds, &told_kinds})
    for (const Kind &kind : *kinds) {
      INFO(kind.name);
      CHECK(told_of(file_of_kind(kind)) == kind.expected);
    }
  for (const Kind &kind : refused_kinds) {
    INFO(kind.name);
    CHECK_THAT(scene_error_of(file_of_kind(kind)), Catch::Contains(kind.expected[0]));
  }
}

TEST_CASE("Cameras and lights are told of where no pose is at their nodes") {
  json gltf = square();
  gltf["cameras"] = json::array({json::object()});
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = json::array({json::object()});
  gltf["nodes"][0]["camera"] = 0;
  gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  CHECK(file_of(gltf).warnings({"object"}).empty());
  const std::vector<Warning> warnings = file_of(gltf).warnings({"other"});
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].code == "gltf-camera");
  CHECK_THAT(warnings[0].place, Catch::EndsWith("scene.gltf: /nodes/0"));
  CHECK_THAT(warnings[0].text, Catch::EndsWith("by the pose {\"node\": \"object\"}"));
  CHECK(warnings[1].code == "gltf-lights");
  CHECK_THAT(warnings[1].text, Catch::StartsWith("1 of 1 light is ignored"));
}

TEST_CASE("Extras of ours that mean nothing are told of") {
  json gltf = square();
  gltf["materials"][0]["extras"] = {
      {"pmdsim_reflectivity", 0.2}, {"pmdsim_point_area_m2", 1e-6}, {"other_program", 1}};
  gltf["meshes"][0]["extras"] = 7;
  CHECK(file_of(gltf).warnings({}).empty());
  gltf["materials"][0]["extras"] = {{"pmdsim_reflectivty", 0.2}};
  gltf["nodes"][0]["extras"] = {{"pmdsim_reflectivity", 0.2}};
  const std::vector<Warning> warnings = file_of(gltf).warnings({});
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].code == "gltf-extras");
  CHECK_THAT(warnings[0].place, Catch::EndsWith("scene.gltf: /materials/0/extras/pmdsim_reflectivty"));
  CHECK_THAT(warnings[1].place, Catch::EndsWith("scene.gltf: /nodes/0/extras/pmdsim_reflectivity"));
}

TEST_CASE("Parts of odd types are not judged") {
  json gltf = square();
  gltf["materials"][0]["extensions"] = 7;
  gltf["materials"][0]["emissiveFactor"] = "much";
  gltf["extensions"] = {1, 2};
  gltf["nodes"][0]["extensions"] = {{"KHR_node_visibility", 3}};
  CHECK(file_of(gltf).warnings({}).empty());
}
