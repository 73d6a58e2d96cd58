#include "engine/view/mesh_edges.h"

#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

namespace pmdsim {
namespace {

std::vector<std::uint32_t> visible_triangles(const CameraScene &camera, const Scene &scene) {
  std::vector<std::uint32_t> ids;
  for (const CameraTriangle &triangle : camera.triangles)
    if (triangle.id < scene.triangles.size()) // discs stand alone
      ids.push_back(triangle.id);
  return ids;
}

// The same of 0 and -0.
std::uint64_t hash_of(const glm::dvec3 &place_m) {
  std::uint64_t hash = 0;
  for (glm::length_t k = 0; k < 3; ++k) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(place_m[k] + 0.0)) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 32;
  }
  return hash;
}

} // namespace

// A table of places by their hashes, twice as large as they are many; a place is looked for from its hash's
// slot on.
std::vector<std::uint32_t> first_at_same_place(const std::vector<glm::dvec3> &positions_m) {
  const std::size_t mask = std::bit_ceil(2 * positions_m.size() + 1) - 1;
  std::vector<std::uint32_t> slots(mask + 1, no_id), first(positions_m.size());
  for (std::uint32_t i = 0; i < positions_m.size(); ++i) {
    std::size_t slot = hash_of(positions_m[i]) & mask;
    while (slots[slot] != no_id && positions_m[slots[slot]] != positions_m[i])
      slot = (slot + 1) & mask;
    if (slots[slot] == no_id)
      slots[slot] = i;
    first[i] = slots[slot];
  }
  return first;
}

// Counted by their lower ends, as many of which there are as vertices, and then sorted among the few of one
// end.
std::vector<WeldedEdge> welded_edges(const Scene &scene, std::span<const std::uint32_t> ids,
                                     const std::vector<std::uint32_t> &first) {
  const auto edge_of = [&](std::uint32_t id, std::uint32_t side) {
    const auto &vertices = scene.triangles[id].vertices;
    const auto [low, high] = std::minmax(first[vertices[side]], first[vertices[(side + 1) % 3]]);
    return WeldedEdge{low, high, id, side};
  };
  std::vector<std::size_t> begin(first.size() + 1);
  for (const std::uint32_t id : ids)
    for (std::uint32_t side = 0; side < 3; ++side)
      ++begin[edge_of(id, side).low + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<WeldedEdge> edges(3 * ids.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const std::uint32_t id : ids)
    for (std::uint32_t side = 0; side < 3; ++side) {
      const WeldedEdge edge = edge_of(id, side);
      edges[next[edge.low]++] = edge;
    }
  for (std::size_t low = 0; low < first.size(); ++low)
    std::ranges::sort(std::span(edges).subspan(begin[low], begin[low + 1] - begin[low]));
  return edges;
}

std::vector<shader::TriangleCorners> triangle_corners(const CameraScene &camera, const Scene &scene) {
  std::vector<shader::TriangleCorners> records(scene.shape_count());
  for (const auto &[corners_m, id] : camera.triangles)
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        records[id].corners[3 * k + axis] = float_pair(corners_m[static_cast<std::size_t>(k)][axis]);
      records[id].beyond[k] = shader::no_triangle;
    }
  // Where more than two triangles share an edge, neighbours in the order of their ids.
  const std::vector<WeldedEdge> edges =
      welded_edges(scene, visible_triangles(camera, scene), first_at_same_place(scene.positions_m));
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const WeldedEdge &a = edges[i - 1], &b = edges[i];
    if (a.low != b.low || a.high != b.high)
      continue;
    records[b.triangle].beyond[b.side] = a.triangle;
    if (records[a.triangle].beyond[a.side] == shader::no_triangle)
      records[a.triangle].beyond[a.side] = b.triangle;
  }
  return records;
}

} // namespace pmdsim
