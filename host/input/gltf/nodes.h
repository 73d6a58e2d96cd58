#pragma once
// The node tree of a glTF file's active scene, flattened, with its transforms in double precision.

#include "engine/model/pose.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

// x_a = linear * x_b + translation_m; unlike a Pose it may scale, shear and mirror.
struct AffineTransform {
  glm::dmat3 linear{1.0};
  glm::dvec3 translation_m{0.0};

  glm::dvec3 point(const glm::dvec3 &p_b) const { return linear * p_b + translation_m; }
};

// a_from_c.
AffineTransform compose(const AffineTransform &a_from_b, const AffineTransform &b_from_c);
// Nothing where the last row is not 0, 0, 0, 1.
std::optional<AffineTransform> affine_transform(const glm::dmat4 &matrix);

// A node in its parent's frame: scaled, then rotated, then moved, or by a matrix in place of all three.
struct NodeTransform {
  glm::dvec3 scale{1.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0}; // a unit quaternion
  glm::dvec3 translation_m{0.0};
  std::optional<AffineTransform> matrix = std::nullopt;

  AffineTransform parent_from_node() const;
};

struct SceneNode {
  std::size_t index;                 // in the file's /nodes
  std::optional<std::size_t> parent; // its place in the list of nodes; nothing for a root
  NodeTransform transform;
};

// Every node of the active scene (`scene`, else the first; none where the file has no scenes), parents before
// their children. Throws Error (input): a cycle, a node with two parents, a transform that is not affine.
std::vector<SceneNode> active_nodes(const tinygltf::Model &model, const Place &root);

// Which of `nodes` each of the file's nodes is; nothing for one that is not in the active scene.
std::vector<std::optional<std::size_t>> places_of_nodes(const tinygltf::Model &model,
                                                        const std::vector<SceneNode> &nodes);

// Where a node is put, whatever its file says; it keeps its own scale, and its children go with it.
struct NodePlacement {
  std::size_t node; // its place in the list of nodes
  Pose world_from_node;
  Place place; // that asks for it, for errors
};

// World from each of `nodes`, parents first. Throws Error (input) where one is not finite, and where one that
// is put elsewhere is sheared.
std::vector<AffineTransform> world_from_nodes(const std::vector<SceneNode> &nodes, const Place &root,
                                              const std::vector<NodePlacement> &placed = {});

} // namespace pmdsim
