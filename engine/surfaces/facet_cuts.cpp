#include "engine/surfaces/facet_cuts.h"

namespace pmdsim {

FacetCuts::FacetCuts(const Elements &elements)
    : roots_(elements.roots), cuts_(elements.nodes.size()), places_(elements.facets.size()) {
  // From how much each corner of a triangle weighs to weights of the second and the third alone.
  const auto plane = [](const glm::dvec3 &weights) {
    return Plane{static_cast<float>(weights.x), static_cast<float>(weights.y - weights.x),
                 static_cast<float>(weights.z - weights.x)};
  };
  std::vector<Open> open;
  for (const std::uint32_t root : roots_)
    if (root != no_node)
      open.push_back({root, glm::dmat3(1.0)});
  while (!open.empty()) {
    const Open now = open.back();
    open.pop_back();
    const FacetNode &node = elements.nodes[now.node];
    const glm::dmat3 in_node = glm::transpose(glm::inverse(now.corners)); // its columns are rows
    if (node.is_leaf()) {
      cuts_[now.node].next = leaf | node.facet;
      places_[node.facet] = {plane(in_node[1]), plane(in_node[2])};
      continue;
    }
    const glm::length_t a = node.edge, b = (a + 1) % 3;
    cuts_[now.node] = {plane(in_node[a] - in_node[b]), node.half};
    Open first{node.half, now.corners}, second{node.half + 1, now.corners};
    first.corners[b] = second.corners[a] = 0.5 * (now.corners[a] + now.corners[b]);
    open.push_back(first);
    open.push_back(second);
  }
}

} // namespace pmdsim
