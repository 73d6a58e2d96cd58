#include "host/input/gltf/skin.h"

#include "host/input/gltf/data/accessor.h"
#include "host/input/gltf/mesh/attributes.h"
#include "host/input/gltf/mesh/mesh.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <tiny_gltf.h>

namespace pmdsim {
namespace {

using Places = std::vector<std::optional<std::size_t>>;

std::vector<Joint> read_joints(const tinygltf::Model &model, const tinygltf::Skin &skin, const Places &places,
                               const Place &place) {
  const Place root{place.file};
  std::vector<glm::dmat4> matrices(skin.joints.size(), glm::dmat4(1.0));
  if (skin.inverseBindMatrices >= 0)
    matrices =
        read_matrices(model, static_cast<std::size_t>(skin.inverseBindMatrices), matrices.size(), root);
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const auto node = static_cast<std::size_t>(skin.joints[i]);
    if (!places[node])
      throw input_error(place / "joints" / i, fmt::format("node {} is not in the active scene", node));
    const std::optional<AffineTransform> joint_from_mesh = affine_transform(matrices[i]);
    if (!joint_from_mesh)
      throw input_error(place / "inverseBindMatrices",
                        fmt::format("matrix {}: expected 0, 0, 0, 1 as the last row", i));
    joints.push_back({*places[node], *joint_from_mesh});
  }
  return joints;
}

// Appends what one set says of `vertex`.
void append_weights(const glm::dvec4 &joints, const glm::dvec4 &weights, SkinWeights &result) {
  for (glm::length_t k = 0; k < 4; ++k) {
    const auto joint = static_cast<std::uint32_t>(joints[k]);
    result.joint_count = std::max(result.joint_count, joint + 1);
    if (weights[k] > 0.0)
      result.weights.push_back({joint, weights[k]});
  }
}

void normalise(SkinWeights &result, std::size_t first, const Place &place) {
  double sum = 0.0;
  for (std::size_t i = first; i < result.weights.size(); ++i)
    sum += result.weights[i].weight;
  if (!(sum > 0.0))
    throw input_error(place / "attributes" / "WEIGHTS_0",
                      fmt::format("the weights of vertex {} are all 0", result.ends.size()));
  for (std::size_t i = first; i < result.weights.size(); ++i)
    result.weights[i].weight /= sum;
}

// What skins have bound so far.
struct Bound {
  std::size_t vertices = 0; // times their sets, each mesh once
  std::size_t weights = 0;  // of each node that places a mesh
};

constexpr std::size_t max_placed_weights = std::size_t{1} << 28;

SkinWeights read_weights(const GltfPrimitive &primitive, Bound &bound) {
  const Place root{primitive.place.file};
  const std::vector<WeightSet> sets = weight_sets(primitive);
  for (const WeightSet &set : sets)
    bound.vertices += primitive.model.accessors[set.joints].count;
  if (bound.vertices > max_scene_vertices)
    throw input_error(primitive.place, fmt::format("skins bind more than {} vertices", max_scene_vertices));
  std::vector<std::vector<glm::dvec4>> joints, weights;
  for (const WeightSet &set : sets) {
    joints.push_back(read_vectors(primitive.model, set.joints, 4, root));
    weights.push_back(read_vectors(primitive.model, set.weights, 4, root));
    for (std::size_t vertex = 0; vertex < weights.back().size(); ++vertex)
      if (glm::any(glm::lessThan(weights.back()[vertex], glm::dvec4(0.0))))
        throw input_error(root / "accessors" / set.weights,
                          fmt::format("element {} has a negative weight", vertex));
  }
  SkinWeights result;
  for (std::size_t vertex = 0; vertex < weights[0].size(); ++vertex) {
    const std::size_t first = result.weights.size();
    for (std::size_t n = 0; n < sets.size(); ++n)
      append_weights(joints[n][vertex], weights[n][vertex], result);
    normalise(result, first, primitive.place);
    result.ends.push_back(result.weights.size());
  }
  return result;
}

// Reads what each primitive of a skinned node's mesh says, once.
void read_mesh(const tinygltf::Model &model, const tinygltf::Node &node, const Place &root, Bound &bound,
               Skins &skins) {
  const auto mesh = static_cast<std::size_t>(node.mesh);
  const std::size_t joints = skins.joints.at(node.skin).size();
  const std::vector<tinygltf::Primitive> &primitives = model.meshes[mesh].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const GltfPrimitive primitive{model, primitives[i], root / "meshes" / mesh / "primitives" / i};
    const auto [known, is_new] = skins.weights.try_emplace({node.mesh, i});
    if (is_new)
      known->second = read_weights(primitive, bound);
    bound.weights += known->second.weights.size();
    if (bound.weights > max_placed_weights)
      throw input_error(primitive.place,
                        fmt::format("nodes place more than {} weights of skins", max_placed_weights));
    if (known->second.joint_count > joints)
      throw input_error(primitive.place / "attributes",
                        fmt::format("refers to joint {}, expected one below {}, as skin {} has",
                                    known->second.joint_count - 1, joints, node.skin));
  }
}

} // namespace

Skins read_skins(const tinygltf::Model &model, const std::vector<SceneNode> &nodes, const Place &root) {
  const Places places = places_of_nodes(model, nodes);
  Skins skins;
  Bound bound;
  for (const SceneNode &scene_node : nodes) {
    const tinygltf::Node &node = model.nodes[scene_node.index];
    if (node.skin < 0)
      continue;
    const auto skin = static_cast<std::size_t>(node.skin);
    const auto [known, is_new] = skins.joints.try_emplace(node.skin);
    if (is_new)
      known->second = read_joints(model, model.skins[skin], places, root / "skins" / skin);
    read_mesh(model, node, root, bound, skins);
  }
  return skins;
}

std::vector<AffineTransform> world_from_mesh_by_joint(const std::vector<Joint> &joints,
                                                      const std::vector<AffineTransform> &world_from_nodes) {
  std::vector<AffineTransform> result;
  result.reserve(joints.size());
  for (const Joint &joint : joints)
    result.push_back(compose(world_from_nodes[joint.node], joint.joint_from_mesh));
  return result;
}

AffineTransform Placement::world_from_mesh(std::size_t vertex) const {
  if (!weights_)
    return world_from_node_;
  AffineTransform blended{glm::dmat3(0.0), glm::dvec3(0.0)};
  for (std::size_t i = vertex == 0 ? 0 : weights_->ends[vertex - 1]; i < weights_->ends[vertex]; ++i) {
    const auto [joint, weight] = weights_->weights[i];
    blended.linear += weight * (*by_joint_)[joint].linear;
    blended.translation_m += weight * (*by_joint_)[joint].translation_m;
  }
  return blended;
}

} // namespace pmdsim
