#include "host/input/gltf/material/material.h"

#include "host/input/file/json_file.h"
#include "host/input/gltf/extensions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr glm::dvec3 luminance_of_rgb{0.2126, 0.7152, 0.0722};
constexpr const char *texture_key = "baseColorTexture";

// The parts of a material that count, with glTF's defaults.
struct Description {
  json base; // pbrMetallicRoughness
  glm::dvec4 factor{1.0};
  std::optional<double> reflectivity;
  std::string alpha_mode;
  double alpha_cutoff; // of MASK, else 0
};

// A number of the material's extras.
std::optional<double> stated(const json &material, const char *key) {
  const json::json_pointer place = json::json_pointer("/extras") / key;
  return material.contains(place) ? std::optional(material.at(place).get<double>()) : std::nullopt;
}

Description described(const json &material) {
  Description result{material.value("pbrMetallicRoughness", json::object()), glm::dvec4(1.0),
                     stated(material, "pmdsim_reflectivity"), material.value("alphaMode", "OPAQUE"), 0.0};
  result.base.value("baseColorFactor", json{1.0, 1.0, 1.0, 1.0}).get_to(result.factor);
  // Above 1 all cutoffs mean the same: nothing is left.
  constexpr double beyond_any_alpha = 2.0;
  if (result.alpha_mode == "MASK")
    result.alpha_cutoff = std::min(material.value("alphaCutoff", 0.5), beyond_any_alpha);
  return result;
}

// KHR_texture_transform: translation * rotation * scale. A positive rotation turns (u, v) counter-clockwise
// as seen in the image, where v points down: the way that the extension's words and its example have it, and
// Blender and the other implementations with them. The GLSL that the extension prints has it the other way
// round.
glm::dmat3 matrix_of(const json &transform) {
  const auto offset = transform.value("offset", json{0.0, 0.0}).get<glm::dvec2>();
  const auto scale = transform.value("scale", json{1.0, 1.0}).get<glm::dvec2>();
  const double rotation = transform.value("rotation", 0.0);
  const double c = std::cos(rotation), s = std::sin(rotation);
  return {scale.x * glm::dvec3(c, -s, 0.0), scale.y * glm::dvec3(s, c, 0.0), glm::dvec3(offset, 1.0)};
}

// `least_alpha` is that of the factor and the texture, without the vertices'.
Surface surface_of(const Description &stated, Paint paint, double least_alpha, bool has_colours) {
  const bool varies = !stated.reflectivity && (paint.texture != nullptr || has_colours);
  const bool has_holes = stated.alpha_cutoff > 0.0 && (has_colours || least_alpha < stated.alpha_cutoff);
  const glm::dvec3 reflectivity_rgb = luminance_of_rgb * glm::dvec3(stated.factor);
  const double luminance = reflectivity_rgb.x + reflectivity_rgb.y + reflectivity_rgb.z;
  Surface surface;
  surface.reflectivity = varies ? 0.0 : stated.reflectivity.value_or(luminance);
  if (varies)
    paint.reflectivity_rgb = reflectivity_rgb;
  if (has_holes) {
    paint.alpha = stated.factor.a;
    paint.alpha_cutoff = stated.alpha_cutoff;
  }
  if (varies || has_holes)
    surface.paint = std::move(paint);
  return surface;
}

} // namespace

GltfMaterials::GltfMaterials(const json &document, std::shared_ptr<const tinygltf::Model> model,
                             const std::filesystem::path &file, UriFiles files)
    : materials_(document.value("materials", json::array())), root_{file},
      textures_(document, std::move(model), file, files) {}

// Returns the least alpha that the texture has.
double GltfMaterials::add_texture(const json &info, Paint &paint, GltfMaterial &result) {
  result.texture_coordinates = info.value("texCoord", 0u);
  if (const json *transform = extension_part(info, "KHR_texture_transform")) {
    result.texture_coordinates = transform->value("texCoord", result.texture_coordinates);
    result.texture_from_coordinates = matrix_of(*transform);
  }
  return static_cast<double>(textures_.add(info.at("index").get<std::size_t>(), paint));
}

GltfMaterial GltfMaterials::material_of(int index, bool has_colours) {
  static const json default_material = json::object();
  const json &material = index < 0 ? default_material : materials_.at(static_cast<std::size_t>(index));
  const Description description = described(material);
  const bool is_blended = description.alpha_mode == "BLEND";
  GltfMaterial result;
  result.blended = is_blended;
  Paint paint;
  double least_alpha = description.factor.a;
  if (description.base.contains(texture_key) &&
      (!description.reflectivity || is_blended || description.alpha_cutoff > 0.0))
    least_alpha *= add_texture(description.base.at(texture_key), paint, result);
  if (is_blended && least_alpha < 1.0)
    throw input_error(root_ / "materials" / static_cast<std::size_t>(index) / "alphaMode",
                      "BLEND is not supported where alpha is below 1 (expected \"MASK\" or \"OPAQUE\")");

  result.surface = surface_of(description, std::move(paint), least_alpha, has_colours);
  result.surface.double_sided = material.value("doubleSided", false);
  result.point_area_m2 = stated(material, "pmdsim_point_area_m2");
  return result;
}

} // namespace pmdsim
