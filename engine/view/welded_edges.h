#pragma once
// Which triangles meet along an edge: files repeat vertices along seams, so places count and not indices.

#include "engine/model/scene.h"

#include <span>
#include <vector>

namespace pmdsim {

// For each of the places the first one at the same coordinates.
std::vector<std::uint32_t> first_at_same_place(const std::vector<glm::dvec3> &positions_m);

struct WeldedEdge {
  std::uint32_t low, high; // first vertices at its ends
  std::uint32_t triangle;  // id
  std::uint32_t side;      // 0: ab, 1: bc, 2: ca
};

// Of the triangles `ids`, those that share an edge side by side, in the order of their ids; `first` as
// first_at_same_place() gives it.
std::vector<WeldedEdge> welded_edges(const Scene &scene, std::span<const std::uint32_t> ids,
                                     const std::vector<std::uint32_t> &first);

} // namespace pmdsim
