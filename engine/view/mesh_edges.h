#pragma once
// Which triangles meet along an edge, and the visible ones as the lens search walks over them. Files repeat
// vertices along seams, so places count and not indices.

#include "engine/model/scene.h"
#include "engine/view/camera_scene.h"

#include <glm/glm.hpp>
#include <span>
#include <tuple>
#include <vector>

namespace pmdsim {

// An order of points, so that what two triangles share is found, and computed with the same bits.
inline bool comes_before(const glm::dvec3 &a, const glm::dvec3 &b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// For each of the places the first one at the same coordinates.
std::vector<std::uint32_t> first_at_same_place(const std::vector<glm::dvec3> &positions_m);

struct WeldedEdge {
  std::uint32_t low, high; // first vertices at its ends
  std::uint32_t triangle;  // id
  std::uint32_t side;      // 0: ab, 1: bc, 2: ca

  auto operator<=>(const WeldedEdge &) const = default;
};

// The edges of the triangles `ids`. Those that several triangles share lie side by side, in the order of
// their ids; `first` as first_at_same_place() gives it.
std::vector<WeldedEdge> welded_edges(const Scene &scene, std::span<const std::uint32_t> ids,
                                     const std::vector<std::uint32_t> &first);

// Corners and neighbours, one record for each of the scene's triangles; those that the lens cannot see are
// zero and nobody's neighbours. Edges are shared where both ends have the same coordinates.
std::vector<shader::TriangleCorners> triangle_corners(const CameraScene &camera, const Scene &scene);

} // namespace pmdsim
