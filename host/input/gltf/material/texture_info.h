#pragma once
// How a glTF material refers to a texture: which one, and by which coordinates.

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace pmdsim {

struct GltfTextureInfo {
  std::size_t texture = 0;                  // index into /textures
  std::uint32_t texture_coordinates = 0;    // n of TEXCOORD_n
  glm::dmat3 texture_from_coordinates{1.0}; // of (u, v, 1): KHR_texture_transform
};

// `info` has passed the glTF schema.
GltfTextureInfo texture_info_of(const nlohmann::json &info);

} // namespace pmdsim
