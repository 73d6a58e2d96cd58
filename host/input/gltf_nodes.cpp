#include "host/input/gltf_nodes.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

namespace pmdsim {

namespace {

AffineTransform compose(const AffineTransform &a_from_b, const AffineTransform &b_from_c) {
  return {a_from_b.linear * b_from_c.linear, a_from_b.point(b_from_c.translation_m)};
}

bool is_finite(const AffineTransform &transform) {
  for (glm::length_t column = 0; column < 3; ++column)
    for (glm::length_t row = 0; row < 3; ++row)
      if (!std::isfinite(transform.linear[column][row]) || !std::isfinite(transform.translation_m[row]))
        return false;
  return true;
}

AffineTransform from_matrix(const std::vector<double> &m, const Place &place) {
  constexpr double rounding = 1e-6; // writers that compute in float leave that much
  if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1.0) > rounding)
    throw input_error(place / "matrix", "expected 0, 0, 0, 1 as the last row");
  return {glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]), glm::dvec3(m[12], m[13], m[14])};
}

glm::dmat3 rotation_matrix(const std::vector<double> &r, const Place &place) {
  const glm::dquat q(r[3], r[0], r[1], r[2]); // glTF writes x, y, z, w
  const double length = glm::length(q);
  if (!(length > 1e-3) || !std::isfinite(length))
    throw input_error(place / "rotation", "expected a unit quaternion");
  return glm::mat3_cast(q / length);
}

AffineTransform parent_from_node(const tinygltf::Node &node, const Place &place) {
  if (!node.matrix.empty())
    return from_matrix(node.matrix, place);
  AffineTransform result;
  if (!node.rotation.empty())
    result.linear = rotation_matrix(node.rotation, place);
  if (!node.scale.empty())
    for (glm::length_t axis = 0; axis < 3; ++axis)
      result.linear[axis] *= node.scale[static_cast<std::size_t>(axis)];
  if (!node.translation.empty())
    result.translation_m = {node.translation[0], node.translation[1], node.translation[2]};
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
    roots.push_back({index, {}});
  }
  return roots;
}

} // namespace

std::vector<SceneNode> active_nodes(const tinygltf::Model &model, const Place &root) {
  const std::vector<bool> has_parent = checked_has_parent(model, root);
  refuse_cycles(model, has_parent, root);
  std::vector<SceneNode> nodes = scene_roots(model, has_parent, root);
  // Until it is reached, a node holds its parent's transform.
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t index = nodes[i].index;
    const Place place = root / "nodes" / index;
    const AffineTransform world_from_node =
        compose(nodes[i].world_from_node, parent_from_node(model.nodes[index], place));
    if (!is_finite(world_from_node))
      throw input_error(place, "its transform is not finite");
    nodes[i].world_from_node = world_from_node;
    for (const int child : model.nodes[index].children)
      nodes.push_back({static_cast<std::size_t>(child), world_from_node});
  }
  return nodes;
}

} // namespace pmdsim
