#pragma once
// glTF skins: meshes that bend with the nodes, the joints, to which their vertices are bound; and where
// vertices stand in the world, bent or not.

#include "host/input/file/input_error.h"
#include "host/input/gltf/nodes.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

struct Joint {
  std::size_t node;                // its place in the list of the active scene's nodes
  AffineTransform joint_from_mesh; // as the mesh was bound: the inverse bind matrix
};

struct JointWeight {
  std::uint32_t joint; // its place in the skin's list
  double weight;       // > 0
};

// The weights that bind a primitive's vertices to joints.
struct SkinWeights {
  std::vector<JointWeight> weights; // one vertex's after the other's
  std::vector<std::size_t> ends;    // where in `weights` each vertex's end; their sum is 1
  std::uint32_t joint_count = 0;    // that are named, the last + 1
};

// Plain data, of the skins that nodes of the active scene use.
struct Skins {
  std::map<int, std::vector<Joint>> joints;                   // by the index in /skins
  std::map<std::pair<int, std::size_t>, SkinWeights> weights; // by the index in /meshes and in its primitives
};

// `nodes` is the active scene's. Throws Error (input).
Skins read_skins(const tinygltf::Model &model, const std::vector<SceneNode> &nodes, const Place &root);

// World from the mesh as each of the joints carries it.
std::vector<AffineTransform> world_from_mesh_by_joint(const std::vector<Joint> &joints,
                                                      const std::vector<AffineTransform> &world_from_nodes);

// Where the vertices of a primitive stand in the world: all where their node takes them, or each where the
// joints of a skin take it.
class Placement {
public:
  explicit Placement(const AffineTransform &world_from_node) : world_from_node_(world_from_node) {}
  // By joint as `weights` counts them; both are referred to.
  Placement(const SkinWeights &weights, const std::vector<AffineTransform> &world_from_mesh_by_joint)
      : weights_(&weights), by_joint_(&world_from_mesh_by_joint) {}

  // World from the mesh, at a vertex of the primitive.
  AffineTransform world_from_mesh(std::size_t vertex) const;

private:
  AffineTransform world_from_node_;
  const SkinWeights *weights_ = nullptr;
  const std::vector<AffineTransform> *by_joint_ = nullptr;
};

} // namespace pmdsim
