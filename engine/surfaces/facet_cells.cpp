#include "engine/surfaces/facet_cells.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

constexpr double cells_of_facet = 8.0; // on average
constexpr std::int32_t most_along = 512;

// How many facets a triangle is cut into.
std::size_t facets_of(const Elements &elements, std::uint32_t root) {
  std::size_t facets = 0;
  std::vector<std::uint32_t> open{root};
  while (!open.empty()) {
    const FacetNode &node = elements.nodes[open.back()];
    open.pop_back();
    if (node.is_leaf()) {
      ++facets;
      continue;
    }
    open.push_back(node.half);
    open.push_back(node.half + 1);
  }
  return facets;
}

std::int32_t leaf_of(const FacetNode &node) { return ~static_cast<std::int32_t>(node.facet); }

} // namespace

FacetCells::FacetCells(const Elements &elements, const std::vector<std::uint32_t> &triangles)
    : cuts_(elements.nodes.size()) {
  for (const std::uint32_t triangle : triangles) {
    add_cuts(elements, elements.roots[triangle]);
    add_cells(elements, elements.roots[triangle]);
  }
  for (std::size_t i = 0; i < 16; ++i) // vectors reach that far
    first_cell_.push_back(0), cells_along_.push_back(1);
}

void FacetCells::show(ScanScene &scene) const {
  scene.first_cell = first_cell_.data();
  scene.cells_along = cells_along_.data();
  scene.cells = cells_.data();
  scene.cuts = cuts_.data();
}

void FacetCells::add_cuts(const Elements &elements, std::uint32_t root) {
  std::vector<Place> open{{root, glm::dmat3(1.0)}};
  while (!open.empty()) {
    const Place now = open.back();
    open.pop_back();
    const FacetNode &node = elements.nodes[now.node];
    if (node.is_leaf()) {
      cuts_[now.node].next = leaf_of(node);
      continue;
    }
    const glm::length_t a = node.edge, b = (a + 1) % 3;
    const glm::dmat3 in_node = glm::transpose(glm::inverse(now.corners)); // its columns are rows
    // As a function of the second and the third weight of the triangle alone.
    const glm::dvec3 side = in_node[a] - in_node[b];
    cuts_[now.node] = {static_cast<float>(side.x), static_cast<float>(side.y - side.x),
                       static_cast<float>(side.z - side.x), static_cast<std::int32_t>(node.half)};
    Place first{node.half, now.corners}, second{node.half + 1, now.corners};
    first.corners[b] = second.corners[a] = 0.5 * (now.corners[a] + now.corners[b]);
    open.push_back(first);
    open.push_back(second);
  }
}

void FacetCells::add_cells(const Elements &elements, std::uint32_t root) {
  const auto facets = static_cast<double>(facets_of(elements, root));
  // Half of the cells lie beyond the triangle.
  const std::int32_t along =
      facets > 1.0 ? std::min(static_cast<std::int32_t>(std::ceil(std::sqrt(2.0 * cells_of_facet * facets))),
                              most_along)
                   : 1;
  // A node that many cuts deep is as large as a cell.
  const int most_cuts = static_cast<int>(2.0 * std::log2(static_cast<double>(along)));
  first_cell_.push_back(static_cast<std::int32_t>(cells_.size()));
  cells_along_.push_back(along);
  const auto middle = [&](std::int32_t i) {
    return (static_cast<float>(i) + 0.5f) / static_cast<float>(along);
  };
  for (std::int32_t row = 0; row < along; ++row)
    for (std::int32_t column = 0; column < along; ++column)
      cells_.push_back(cell_at(elements, root, middle(column), middle(row), most_cuts));
}

std::int32_t FacetCells::cell_at(const Elements &elements, std::uint32_t root, float u, float v,
                                 int most_cuts) const {
  std::uint32_t node = root;
  for (int cut = 0; cut < most_cuts && !elements.nodes[node].is_leaf(); ++cut) {
    const FacetCut &side = cuts_[node];
    node = elements.nodes[node].half + (side.at + side.u * u + side.v * v >= 0.0f ? 0 : 1);
  }
  return elements.nodes[node].is_leaf() ? leaf_of(elements.nodes[node]) : static_cast<std::int32_t>(node);
}

} // namespace pmdsim
