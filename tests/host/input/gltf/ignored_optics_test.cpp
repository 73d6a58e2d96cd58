#include "host/input/gltf/material/ignored_optics.h"

#include <catch2/catch.hpp>

using nlohmann::json;

namespace {

using Words = std::vector<std::string>;

// The codes of the optics that the material shows, without what they all begin with.
Words gloss_of(const json &material) {
  constexpr std::string_view prefix = "gltf-";
  Words words;
  for (const pmdsim::IgnoredOptics &optics : pmdsim::ignored_optics())
    if (optics.is_shown(material))
      words.emplace_back(std::string_view(optics.code).substr(prefix.size()));
  return words;
}

Words gloss_of_base(const char *base) { return gloss_of({{"pbrMetallicRoughness", json::parse(base)}}); }

Words gloss_of_extension(const char *name, const char *part) {
  return gloss_of({{"extensions", {{name, json::parse(part)}}}});
}

} // namespace

TEST_CASE("A material is metallic where its file says so") {
  CHECK(gloss_of(json::object()).empty());
  CHECK(gloss_of_base("{}").empty());
  CHECK(gloss_of_base(R"({"metallicFactor": 0.51})") == Words{"metallic"});
  CHECK(gloss_of_base(R"({"metallicFactor": 0.5, "roughnessFactor": 0.4})").empty());
  CHECK(gloss_of_base(R"({"metallicRoughnessTexture": {"index": 0}})") == Words{"metallic"});
  CHECK(gloss_of_base(R"({"metallicFactor": 0, "metallicRoughnessTexture": {"index": 0}})").empty());
}

TEST_CASE("Where no metallic factor is written, roughness tells") {
  CHECK(gloss_of_base(R"({"roughnessFactor": 0.5})").empty());
  CHECK(gloss_of_base(R"({"roughnessFactor": 0.49})") == Words{"metallic"});
  CHECK(gloss_of_base(R"({"roughnessFactor": 0.29})") == Words{"metallic", "glossy"});
  CHECK(gloss_of_base(R"({"metallicFactor": 0, "roughnessFactor": 0.29})") == Words{"glossy"});
  CHECK(gloss_of_base(R"({"metallicFactor": 0, "roughnessFactor": 0.3})").empty());
}

TEST_CASE("Blender leaves out the metallic factor of a metal") {
  const json rough = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.8}}}};
  const std::string_view blender = "Khronos glTF Blender I/O v4.2.57";
  CHECK(gloss_of(pmdsim::as_meant(rough, blender)) == Words{"metallic"});
  CHECK(gloss_of(pmdsim::as_meant(rough, "another exporter")).empty());
  json plain = rough;
  plain["pbrMetallicRoughness"]["metallicFactor"] = 0;
  CHECK(gloss_of(pmdsim::as_meant(plain, blender)).empty());
  CHECK(gloss_of(pmdsim::as_meant({{"name", "no base"}}, blender)).empty());
  CHECK(gloss_of(pmdsim::as_meant({{"pbrMetallicRoughness", 7}}, blender)).empty());
}

TEST_CASE("A material transmits by extensions whose factor is above zero") {
  const Words transmitting{"transmission"};
  CHECK(gloss_of_extension("KHR_materials_transmission", R"({"transmissionFactor": 0.9})") == transmitting);
  CHECK(gloss_of_extension("KHR_materials_transmission", R"({"transmissionFactor": 0})").empty());
  CHECK(gloss_of_extension("KHR_materials_transmission", "{}").empty());
  CHECK(gloss_of_extension("KHR_materials_volume", R"({"thicknessFactor": 0.01})") == Words{"volume"});
  CHECK(gloss_of_extension("KHR_materials_specular", R"({"specularFactor": 1})").empty());
  CHECK(gloss_of_extension("KHR_materials_diffuse_transmission", R"({"diffuseTransmissionFactor": 1})") ==
        transmitting);
}

TEST_CASE("A material of odd types is not judged") {
  CHECK(gloss_of({{"pbrMetallicRoughness", {{"metallicFactor", "much"}}}, {"extensions", 7}}).empty());
  CHECK(gloss_of({{"extensions", {{"KHR_materials_transmission", {1}}}}}).empty());
}
