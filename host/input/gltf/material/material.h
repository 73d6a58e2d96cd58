#pragma once
// The properties of a glTF material that matter to the simulator: how much it reflects, where it is, and
// whether its back is visible.

#include "engine/model/scene.h"
#include "host/input/gltf/material/textures.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace pmdsim {

struct GltfMaterial {
  Surface surface;
  // Where the surface's paint has a texture: which TEXCOORD_n, and the texture's (u, v, 1) from them.
  std::uint32_t texture_coordinates = 0;
  glm::dmat3 texture_from_coordinates{1.0};
  std::optional<double> point_area_m2; // > 0
  bool blended = false; // alphaMode BLEND: vertex colours with an alpha below 1 would be translucent
};

// A file's materials. Textures are opened when a material first needs them.
class GltfMaterials {
public:
  // As GltfTextures.
  GltfMaterials(const nlohmann::json &document, std::shared_ptr<const tinygltf::Model> model,
                const std::filesystem::path &file, UriFiles files = UriFiles::beside);

  // /materials/`material`, which exists; -1 is glTF's default, white and single-sided. `has_colours`: whether
  // the primitive has vertex colours. Reflectivity is `extras.pmdsim_reflectivity` if given, else the
  // luminance (ITU-R BT.709) of the linear base colour. alphaMode MASK masks; BLEND is taken as OPAQUE where
  // neither the factor nor the texture has an alpha below 1, else refused. Throws Error (input).
  GltfMaterial material_of(int material, bool has_colours);

private:
  double add_texture(const nlohmann::json &info, Paint &paint, GltfMaterial &result);

  nlohmann::json materials_;
  Place root_;
  GltfTextures textures_;
};

} // namespace pmdsim
