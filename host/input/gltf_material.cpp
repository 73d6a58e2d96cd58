#include "host/input/gltf_material.h"

#include <tiny_gltf.h>

namespace pmdsim {

namespace {

constexpr const char *reflectivity_key = "pmdsim_reflectivity";

double reflectivity_of(const tinygltf::Material &material) {
  if (material.extras.IsObject() && material.extras.Has(reflectivity_key))
    return material.extras.Get(reflectivity_key).GetNumberAsDouble();
  const std::vector<double> &rgba = material.pbrMetallicRoughness.baseColorFactor;
  return 0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2];
}

} // namespace

Surface surface_of(const tinygltf::Material &material, const Place &place) {
  if (material.pbrMetallicRoughness.baseColorTexture.index >= 0)
    throw input_error(place / "pbrMetallicRoughness" / "baseColorTexture", "textures are not supported yet");
  if (material.alphaMode != "OPAQUE")
    throw input_error(place / "alphaMode",
                      material.alphaMode + " is not supported yet (expected \"OPAQUE\")");
  return {reflectivity_of(material), material.doubleSided};
}

} // namespace pmdsim
