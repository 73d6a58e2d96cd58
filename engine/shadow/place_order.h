#pragma once
// An order in which places that follow each other lie close together.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// The numbers of the places along a Morton curve through a grid of 1024 cells a side.
std::vector<std::uint32_t> order_by_place(const std::vector<glm::dvec3> &places_m);

} // namespace pmdsim
