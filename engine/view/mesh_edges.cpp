#include "engine/view/mesh_edges.h"

#include "engine/vulkan/float_pair.h"

#include <algorithm>
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

} // namespace

std::vector<std::uint32_t> first_at_same_place(const std::vector<glm::dvec3> &positions_m) {
  std::vector<std::uint32_t> order(positions_m.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, comes_before, [&](std::uint32_t v) { return positions_m[v]; });
  std::vector<std::uint32_t> first(positions_m.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] =
        i > 0 && positions_m[order[i]] == positions_m[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

std::vector<WeldedEdge> welded_edges(const Scene &scene, std::span<const std::uint32_t> ids,
                                     const std::vector<std::uint32_t> &first) {
  std::vector<WeldedEdge> edges;
  edges.reserve(3 * ids.size());
  for (const std::uint32_t id : ids) {
    const auto &vertices = scene.triangles[id].vertices;
    for (std::uint32_t side = 0; side < 3; ++side) {
      const auto [low, high] = std::minmax(first[vertices[side]], first[vertices[(side + 1) % 3]]);
      edges.push_back({low, high, id, side});
    }
  }
  std::ranges::sort(edges);
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
