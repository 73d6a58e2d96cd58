#pragma once
// The reflectivity of a shape at a place of it, in double, and whether it is there (docs/setup.md).

#include "engine/model/scene.h"

namespace pmdsim {

// How much each corner of a triangle counts at a place of it.
using CornerWeights = glm::dvec3;

// rho of the triangle or disc with that id.
double reflectivity_at(const Scene &scene, std::uint32_t shape, const CornerWeights &weights);
// False within a cutout of its paint.
bool is_there_at(const Scene &scene, std::uint32_t triangle, const CornerWeights &weights);
// The mean rho of the part of a triangle between three places, by area.
double mean_reflectivity(const Scene &scene, std::uint32_t triangle,
                         const std::array<CornerWeights, 3> &corners);

} // namespace pmdsim
