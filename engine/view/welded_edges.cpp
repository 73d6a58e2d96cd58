#include "engine/view/welded_edges.h"

#include "engine/view/vertex_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pmdsim {

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
  std::ranges::sort(edges, {},
                    [](const WeldedEdge &e) { return std::tuple(e.low, e.high, e.triangle, e.side); });
  return edges;
}

} // namespace pmdsim
