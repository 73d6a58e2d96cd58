#pragma once
// Colours from textures by the rules of glTF's samplers, which are Vulkan's, in double.

#include "engine/model/scene.h"

namespace pmdsim::reference {

// RGBA of the paint's texture (which must be there) at the texture coordinates (u, v), finite.
glm::dvec4 texture_colour(const Paint &paint, const glm::dvec2 &coordinates);

} // namespace pmdsim::reference
