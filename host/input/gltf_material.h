#pragma once
// What of a glTF material matters to the simulator: how much it reflects and whether its back is visible.

#include "engine/scene.h"
#include "host/input/input_error.h"

namespace tinygltf {
struct Material;
}

namespace pmdsim {

// Reflectivity: `extras.pmdsim_reflectivity` if given, else the luminance (ITU-R BT.709) of the linear base
// colour. Throws Error (input) for textures and alpha modes, which are not supported yet.
Surface surface_of(const tinygltf::Material &material, const Place &place);

} // namespace pmdsim
