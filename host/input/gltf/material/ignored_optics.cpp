#include "host/input/gltf/material/ignored_optics.h"

#include "engine/model/warning.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace pmdsim {

using nlohmann::json;

namespace {

const json *value_at(const json &material, const char *pointer) {
  const json::json_pointer place(pointer);
  return material.contains(place) ? &material.at(place) : nullptr;
}

std::optional<double> number_at(const json &material, const char *pointer) {
  const json *value = value_at(material, pointer);
  return value != nullptr && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

bool is_above_zero(const json &material, const char *pointer) {
  return number_at(material, pointer).value_or(0.0) > 0.0;
}

// Whether any of an array's numbers is not `plain`.
bool has_other_than(const json &material, const char *pointer, double plain) {
  const json *values = value_at(material, pointer);
  return values != nullptr && values->is_array() && std::ranges::any_of(*values, [&](const json &value) {
           return value.is_number() && value.get<double>() != plain;
         });
}

bool is_metallic(const json &material) {
  if (const auto metallic = number_at(material, "/pbrMetallicRoughness/metallicFactor"))
    return *metallic > 0.5;
  return value_at(material, "/pbrMetallicRoughness/metallicRoughnessTexture") != nullptr ||
         number_at(material, "/pbrMetallicRoughness/roughnessFactor").value_or(1.0) < 0.5;
}

bool is_glossy(const json &material) {
  return number_at(material, "/pbrMetallicRoughness/roughnessFactor").value_or(1.0) < 0.3;
}

bool is_transmitting(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_transmission/transmissionFactor") ||
         is_above_zero(material, "/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor");
}

bool is_volume(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_volume/thicknessFactor");
}

bool is_emitting(const json &material) { return has_other_than(material, "/emissiveFactor", 0.0); }

bool has_normal_map(const json &material) {
  return value_at(material, "/normalTexture") != nullptr &&
         number_at(material, "/normalTexture/scale").value_or(1.0) != 0.0;
}

bool has_occlusion_map(const json &material) {
  return value_at(material, "/occlusionTexture") != nullptr &&
         number_at(material, "/occlusionTexture/strength").value_or(1.0) != 0.0;
}

bool is_coated(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_clearcoat/clearcoatFactor");
}

bool has_sheen(const json &material) {
  return has_other_than(material, "/extensions/KHR_materials_sheen/sheenColorFactor", 0.0);
}

bool is_iridescent(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_iridescence/iridescenceFactor");
}

bool is_anisotropic(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_anisotropy/anisotropyStrength");
}

// A factor of 0 asks for no reflection at all, which is what is simulated.
bool is_specular(const json &material) {
  const json *part = value_at(material, "/extensions/KHR_materials_specular");
  const double factor =
      number_at(material, "/extensions/KHR_materials_specular/specularFactor").value_or(1.0);
  return part != nullptr && part->is_object() && factor != 0.0 &&
         (factor != 1.0 || part->contains("specularTexture") || part->contains("specularColorTexture") ||
          has_other_than(material, "/extensions/KHR_materials_specular/specularColorFactor", 1.0));
}

// Of what light enters: elsewhere it changes the gloss alone.
bool has_other_ior(const json &material) {
  constexpr double plain = 1.5;
  return (is_transmitting(material) || is_volume(material)) &&
         number_at(material, "/extensions/KHR_materials_ior/ior").value_or(plain) != plain;
}

bool is_dispersive(const json &material) {
  return is_above_zero(material, "/extensions/KHR_materials_dispersion/dispersion");
}

bool is_unlit(const json &material) {
  return value_at(material, "/extensions/KHR_materials_unlit") != nullptr;
}

bool has_specular_glossiness(const json &material) {
  return value_at(material, "/extensions/KHR_materials_pbrSpecularGlossiness") != nullptr;
}

constexpr const char *matt = "light is scattered as by a matt surface of the base colour";

} // namespace

const std::vector<IgnoredOptics> &ignored_optics() {
  static const std::vector<IgnoredOptics> all{
      {warning_code("gltf-metallic"), is_metallic, "is metallic", "are metallic", matt},
      {warning_code("gltf-glossy"), is_glossy, "is glossy", "are glossy", matt},
      {warning_code("gltf-transmission"), is_transmitting, "lets light through", "let light through",
       "no light passes them, they are opaque; leave out what the camera should look through"},
      {warning_code("gltf-volume"), is_volume, "has a volume", "have a volume",
       "light does not enter them, they are opaque and matt"},
      {warning_code("gltf-emission"), is_emitting, "emits light", "emit light",
       "no light comes from there; light of the surroundings is background_radiance_w_m2_sr of a sensor's "
       "electronics"},
      {warning_code("gltf-normal-map"), has_normal_map, "has a normal map", "have normal maps",
       "light is scattered about the triangles' own normals; model relief that matters as triangles"},
      {warning_code("gltf-occlusion-map"), has_occlusion_map, "has an occlusion map", "have occlusion maps",
       "diodes' light is shadowed by the scene's triangles alone"},
      {warning_code("gltf-clearcoat"), is_coated, "has a clear coat", "have clear coats", matt},
      {warning_code("gltf-sheen"), has_sheen, "has a sheen", "have a sheen", matt},
      {warning_code("gltf-iridescence"), is_iridescent, "is iridescent", "are iridescent", matt},
      {warning_code("gltf-anisotropy"), is_anisotropic, "is anisotropic", "are anisotropic", matt},
      {warning_code("gltf-specular"), is_specular, "has a specular reflection of its own",
       "have specular reflections of their own", matt},
      {warning_code("gltf-ior"), has_other_ior, "has a refractive index", "have refractive indices",
       "nothing is refracted, and light is scattered as by a matt surface"},
      {warning_code("gltf-dispersion"), is_dispersive, "disperses light", "disperse light",
       "nothing is refracted, and light is scattered as by a matt surface"},
      {warning_code("gltf-unlit"), is_unlit, "is unlit", "are unlit",
       "their base colour is taken for the reflectivity of a matt surface that light has to reach"},
      {warning_code("gltf-specular-glossiness"), has_specular_glossiness, "has specular-glossiness colours",
       "have specular-glossiness colours",
       "only the base colour of pbrMetallicRoughness is read, which is white where none is there; convert "
       "them, or state extras.pmdsim_reflectivity"},
  };
  return all;
}

json as_meant(json material, std::string_view generator) {
  constexpr std::string_view blender = "Blender I/O"; // "Khronos glTF Blender I/O v4.2.57"
  const json::json_pointer base("/pbrMetallicRoughness"), metallic = base / "metallicFactor";
  if (generator.find(blender) != generator.npos && material.contains(base) && material.at(base).is_object() &&
      !material.contains(metallic))
    material[metallic] = 1.0;
  return material;
}

} // namespace pmdsim
