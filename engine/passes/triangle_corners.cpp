#include "engine/passes/triangle_corners.h"

#include "engine/passes/double_pair.h"
#include "engine/passes/vertex_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pmdsim {
namespace {

// For each of the scene's vertices the first one at the same place: files repeat them along seams.
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

struct Edge {
  std::uint32_t low, high; // vertices
  std::uint32_t triangle;  // id
  std::uint32_t side;      // 0: ab, 1: bc, 2: ca
};

std::vector<Edge> sorted_edges(const CameraScene &camera, const Scene &scene) {
  const std::vector<std::uint32_t> first = first_at_same_place(scene.positions_m);
  std::vector<Edge> edges;
  edges.reserve(3 * camera.triangles.size());
  for (const CameraTriangle &triangle : camera.triangles) {
    if (triangle.id >= scene.triangles.size())
      continue; // discs stand alone
    const auto &vertices = scene.triangles[triangle.id].vertices;
    for (std::uint32_t side = 0; side < 3; ++side) {
      const auto [low, high] = std::minmax(first[vertices[side]], first[vertices[(side + 1) % 3]]);
      edges.push_back({low, high, triangle.id, side});
    }
  }
  std::ranges::sort(edges, {}, [](const Edge &e) { return std::tuple(e.low, e.high, e.triangle, e.side); });
  return edges;
}

} // namespace

std::vector<shader::TriangleCorners> triangle_corners(const CameraScene &camera, const Scene &scene) {
  std::vector<shader::TriangleCorners> records(scene.shape_count());
  for (const auto &[corners_m, id] : camera.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const DoublePair4 pair(corners_m[k], 0.0);
      records[id].hi[k] = pair.hi;
      records[id].lo[k] = pair.lo;
      records[id].beyond[k] = shader::no_triangle;
    }
  // Where more than two triangles share an edge, neighbours in the order of their ids.
  const std::vector<Edge> edges = sorted_edges(camera, scene);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Edge &a = edges[i - 1], &b = edges[i];
    if (a.low != b.low || a.high != b.high)
      continue;
    records[b.triangle].beyond[b.side] = a.triangle;
    if (records[a.triangle].beyond[a.side] == shader::no_triangle)
      records[a.triangle].beyond[a.side] = b.triangle;
  }
  return records;
}

} // namespace pmdsim
