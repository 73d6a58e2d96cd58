#pragma once
// What a painted surface reflects, and whether it is there at all, at one point of a triangle or disc: where
// its corners count `weights`, which add up to 1. Of a disc the first corner is its vertex, the others do not
// matter.

#include "engine/model/scene.h"

#include <cstdint>

namespace pmdsim::reference {

bool is_there(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights);
double painted_reflectivity(const Scene &scene, std::uint32_t id, const glm::dvec3 &weights); // rho

} // namespace pmdsim::reference
