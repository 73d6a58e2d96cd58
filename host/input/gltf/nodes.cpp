#include "host/input/gltf/nodes.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

namespace pmdsim {
namespace {

bool is_finite(const AffineTransform &transform) {
  for (glm::length_t column = 0; column < 3; ++column)
    for (glm::length_t row = 0; row < 3; ++row)
      if (!std::isfinite(transform.linear[column][row]) || !std::isfinite(transform.translation_m[row]))
        return false;
  return true;
}

glm::dquat unit_quaternion(const std::vector<double> &r, const Place &place) {
  const glm::dquat q(r[3], r[0], r[1], r[2]); // glTF writes x, y, z, w
  constexpr double rounding = 0.01;           // of those that write few digits
  const double length = glm::length(q);
  if (!(std::abs(length - 1.0) < rounding))
    throw input_error(
        place / "rotation",
        fmt::format("expected a unit quaternion x, y, z, w, found one of length {:.4g}", length));
  return q / length;
}

NodeTransform transform_of(const tinygltf::Node &node, const Place &place) {
  NodeTransform result;
  if (!node.matrix.empty()) {
    result.matrix = affine_transform(glm::make_mat4(node.matrix.data()));
    if (!result.matrix)
      throw input_error(place / "matrix", "expected 0, 0, 0, 1 as the last row");
  }
  if (!node.rotation.empty())
    result.rotation = unit_quaternion(node.rotation, place);
  if (!node.scale.empty())
    result.scale = glm::make_vec3(node.scale.data());
  if (!node.translation.empty())
    result.translation_m = glm::make_vec3(node.translation.data());
  return result;
}

std::vector<bool> checked_has_parent(const tinygltf::Model &model, const Place &root) {
  std::vector<bool> has_parent(model.nodes.size(), false);
  for (const tinygltf::Node &node : model.nodes)
    for (const int child_index : node.children) {
      const auto child = static_cast<std::size_t>(child_index);
      if (has_parent[child])
        throw input_error(root / "nodes" / child, "is the child of two nodes");
      has_parent[child] = true;
    }
  return has_parent;
}

// With at most one parent each, the nodes that no parentless node leads to are those in or below a cycle.
void refuse_cycles(const tinygltf::Model &model, const std::vector<bool> &has_parent, const Place &root) {
  std::vector<bool> reached(model.nodes.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (!has_parent[i])
      open.push_back(i);
  while (!open.empty()) {
    const std::size_t index = open.back();
    open.pop_back();
    reached[index] = true;
    for (const int child : model.nodes[index].children)
      open.push_back(static_cast<std::size_t>(child));
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (!reached[i])
      throw input_error(root / "nodes" / i, "the nodes form a cycle");
}

std::vector<SceneNode> scene_roots(const tinygltf::Model &model, const std::vector<bool> &has_parent,
                                   const Place &root) {
  if (model.scenes.empty())
    return {};
  const std::size_t scene = model.defaultScene < 0 ? 0 : static_cast<std::size_t>(model.defaultScene);
  const std::vector<int> &listed = model.scenes[scene].nodes;
  std::vector<bool> seen(model.nodes.size(), false);
  std::vector<SceneNode> roots;
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const auto index = static_cast<std::size_t>(listed[i]);
    if (has_parent[index] || seen[index])
      throw input_error(root / "scenes" / scene / "nodes" / i,
                        fmt::format("node {} is {}", index,
                                    seen[index] ? "listed twice" : "the child of another, expected a root"));
    seen[index] = true;
    roots.push_back({index, std::nullopt, {}});
  }
  return roots;
}

// The node's transform at another pose: its axes are turned as a whole, their lengths stay.
AffineTransform put_at(const NodePlacement &placement, const AffineTransform &world_from_node) {
  constexpr double rounding = 1e-6;
  const glm::dmat3 &linear = world_from_node.linear;
  const glm::dvec3 lengths(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
  for (glm::length_t i = 0; i < 3; ++i)
    for (glm::length_t j = 0; j < i; ++j)
      if (!(std::abs(glm::dot(linear[i], linear[j])) <= rounding * lengths[i] * lengths[j]))
        throw input_error(placement.place,
                          "the node is sheared, expected one that is turned, scaled and moved alone");
  if (glm::determinant(linear) < 0.0)
    throw input_error(placement.place,
                      "the node is mirrored, expected one that is turned, scaled and moved alone");
  AffineTransform result{placement.world_from_node.rotation, placement.world_from_node.translation_m};
  for (glm::length_t axis = 0; axis < 3; ++axis)
    result.linear[axis] *= lengths[axis];
  return result;
}

} // namespace

AffineTransform compose(const AffineTransform &a_from_b, const AffineTransform &b_from_c) {
  return {a_from_b.linear * b_from_c.linear, a_from_b.point(b_from_c.translation_m)};
}

std::optional<AffineTransform> affine_transform(const glm::dmat4 &m) {
  constexpr double rounding = 1e-6; // writers that compute in float leave that much
  if (!(std::abs(m[0].w) + std::abs(m[1].w) + std::abs(m[2].w) + std::abs(m[3].w - 1.0) <= rounding))
    return std::nullopt;
  return AffineTransform{glm::dmat3(m), glm::dvec3(m[3])};
}

AffineTransform NodeTransform::parent_from_node() const {
  if (matrix)
    return *matrix;
  AffineTransform result{glm::mat3_cast(rotation), translation_m};
  for (glm::length_t axis = 0; axis < 3; ++axis)
    result.linear[axis] *= scale[axis];
  return result;
}

std::vector<SceneNode> active_nodes(const tinygltf::Model &model, const Place &root) {
  const std::vector<bool> has_parent = checked_has_parent(model, root);
  refuse_cycles(model, has_parent, root);
  std::vector<SceneNode> nodes = scene_roots(model, has_parent, root);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t index = nodes[i].index;
    nodes[i].transform = transform_of(model.nodes[index], root / "nodes" / index);
    for (const int child : model.nodes[index].children)
      nodes.push_back({static_cast<std::size_t>(child), i, {}});
  }
  return nodes;
}

std::vector<std::optional<std::size_t>> places_of_nodes(const tinygltf::Model &model,
                                                        const std::vector<SceneNode> &nodes) {
  std::vector<std::optional<std::size_t>> places(model.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    places[nodes[i].index] = i;
  return places;
}

std::vector<AffineTransform> world_from_nodes(const std::vector<SceneNode> &nodes, const Place &root,
                                              const std::vector<NodePlacement> &placed) {
  std::vector<const NodePlacement *> placement_of(nodes.size(),
                                                  nullptr); // the first one, where there are several
  for (const NodePlacement &placement : placed)
    if (const NodePlacement *&of = placement_of[placement.node]; of == nullptr)
      of = &placement;
  std::vector<AffineTransform> world_from;
  world_from.reserve(nodes.size());
  for (const SceneNode &node : nodes) {
    const AffineTransform parent_from_node = node.transform.parent_from_node();
    world_from.push_back(node.parent ? compose(world_from[*node.parent], parent_from_node)
                                     : parent_from_node);
    if (const NodePlacement *placement = placement_of[world_from.size() - 1])
      world_from.back() = put_at(*placement, world_from.back());
    if (!is_finite(world_from.back()))
      throw input_error(root / "nodes" / node.index, "its transform is not finite");
  }
  return world_from;
}

} // namespace pmdsim
