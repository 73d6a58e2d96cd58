#pragma once
// What of a glTF material matters to the simulator: how much it reflects and whether its back is visible.

#include "engine/scene.h"
#include "host/input/input_error.h"

namespace tinygltf {
struct Material;
}

namespace pmdsim {

struct GltfMaterial {
  Surface surface;
  std::uint32_t texture_coordinates = 0;    // which TEXCOORD_n
  glm::dmat3 texture_from_coordinates{1.0}; // homogeneous (u,v,1), KHR_texture_transform
};

// Reflectivity: `extras.pmdsim_reflectivity` if given, else the luminance (ITU-R BT.709) of the linear base
// colour, times the vertices' where they have one. Throws Error (input) for textures and alpha modes, which
// are not supported yet.
GltfMaterial material_of(const tinygltf::Material &material, const Place &place, bool vertex_colours);

} // namespace pmdsim
