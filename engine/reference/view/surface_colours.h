#pragma once
// The reflectivity of a surface, painted or not, and whether it is there at all, at one point of a triangle
// or disc: where its corners count `weights`, which add up to 1. A disc's first corner is its vertex; the
// others do not matter.

#include "engine/model/scene.h"

#include <cstdint>

namespace pmdsim::reference {

// RGBA of the paint's texture (which must be there) at the texture coordinates (u, v), finite, by the rules
// of glTF's samplers, which are Vulkan's.
glm::dvec4 texture_colour(const Paint &paint, const glm::dvec2 &coordinates);

bool is_there(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights);
double reflectivity(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights); // rho

} // namespace pmdsim::reference
