#include "host/input/gltf/material/texture_info.h"

#include "host/input/gltf/extensions.h"

#include <cmath>

namespace pmdsim {

using nlohmann::json;

namespace {

glm::dvec2 pair(const json &object, const char *key, const glm::dvec2 &otherwise) {
  if (!object.contains(key))
    return otherwise;
  return {object.at(key).at(0).get<double>(), object.at(key).at(1).get<double>()};
}

// Translation * rotation * scale. A positive rotation turns (u, v) counter-clockwise as seen in the image,
// where v points down: the way that the extension's words and its example have it, and Blender and the other
// implementations with them. The GLSL that the extension prints has it the other way round.
glm::dmat3 matrix_of(const json &transform) {
  const glm::dvec2 offset = pair(transform, "offset", {0.0, 0.0});
  const glm::dvec2 scale = pair(transform, "scale", {1.0, 1.0});
  const double rotation = transform.value("rotation", 0.0);
  const double c = std::cos(rotation), s = std::sin(rotation);
  return {scale.x * glm::dvec3(c, -s, 0.0), scale.y * glm::dvec3(s, c, 0.0), glm::dvec3(offset, 1.0)};
}

} // namespace

GltfTextureInfo texture_info_of(const json &info) {
  GltfTextureInfo result{info.at("index").get<std::size_t>(), info.value("texCoord", 0u)};
  if (const json *transform = extension_part(info, "KHR_texture_transform")) {
    result.texture_coordinates = transform->value("texCoord", result.texture_coordinates);
    result.texture_from_coordinates = matrix_of(*transform);
  }
  return result;
}

} // namespace pmdsim
