#include "host/input/gltf/material/gloss.h"

#include <optional>

namespace pmdsim {

using nlohmann::json;

namespace {

std::optional<double> number_at(const json &material, const char *pointer) {
  const json::json_pointer place(pointer);
  return material.contains(place) && material.at(place).is_number()
             ? std::optional(material.at(place).get<double>())
             : std::nullopt;
}

bool is_metallic(const json &material) {
  if (const auto metallic = number_at(material, "/pbrMetallicRoughness/metallicFactor"))
    return *metallic > 0.5;
  static const json::json_pointer texture("/pbrMetallicRoughness/metallicRoughnessTexture");
  return material.contains(texture) ||
         number_at(material, "/pbrMetallicRoughness/roughnessFactor").value_or(1.0) < 0.5;
}

bool is_glossy(const json &material) {
  return number_at(material, "/pbrMetallicRoughness/roughnessFactor").value_or(1.0) < 0.3;
}

bool is_transmitting(const json &material) {
  for (const char *factor : {"/extensions/KHR_materials_transmission/transmissionFactor",
                             "/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor",
                             "/extensions/KHR_materials_volume/thicknessFactor"})
    if (number_at(material, factor).value_or(0.0) > 0.0)
      return true;
  return false;
}

} // namespace

std::vector<std::string> gloss_of(const json &material) {
  std::vector<std::string> words;
  if (is_metallic(material))
    words.emplace_back("metallic");
  if (is_glossy(material))
    words.emplace_back("glossy");
  if (is_transmitting(material))
    words.emplace_back("transmitting");
  return words;
}

} // namespace pmdsim
