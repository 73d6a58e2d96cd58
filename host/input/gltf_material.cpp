#include "host/input/gltf_material.h"

#include <tiny_gltf.h>

namespace pmdsim {

namespace {

constexpr const char *reflectivity_key = "pmdsim_reflectivity";

bool has_own_reflectivity(const tinygltf::Material &material) {
  return material.extras.IsObject() && material.extras.Has(reflectivity_key);
}

// What each component of the linear base colour adds.
glm::dvec3 reflectivity_rgb(const tinygltf::Material &material) {
  const std::vector<double> &rgba = material.pbrMetallicRoughness.baseColorFactor;
  return {0.2126 * rgba[0], 0.7152 * rgba[1], 0.0722 * rgba[2]};
}

} // namespace

GltfMaterial material_of(const tinygltf::Material &material, const Place &place, bool vertex_colours) {
  if (material.pbrMetallicRoughness.baseColorTexture.index >= 0)
    throw input_error(place / "pbrMetallicRoughness" / "baseColorTexture", "textures are not supported yet");
  if (material.alphaMode != "OPAQUE")
    throw input_error(place / "alphaMode",
                      material.alphaMode + " is not supported yet (expected \"OPAQUE\")");
  GltfMaterial result;
  result.surface.double_sided = material.doubleSided;
  if (has_own_reflectivity(material)) {
    result.surface.reflectivity = material.extras.Get(reflectivity_key).GetNumberAsDouble();
    return result;
  }
  const glm::dvec3 rgb = reflectivity_rgb(material);
  result.surface.reflectivity = vertex_colours ? 0.0 : rgb.r + rgb.g + rgb.b;
  if (vertex_colours)
    result.surface.paint = Paint{.reflectivity_rgb = rgb};
  return result;
}

} // namespace pmdsim
