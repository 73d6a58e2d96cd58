#pragma once
// Where the vertices of a glTF primitive stand in the world.

#include "host/input/gltf/nodes.h"
#include "host/input/gltf/skin.h"

#include <cstddef>
#include <vector>

namespace pmdsim {

// All where their node takes them, or each where the joints of a skin take it.
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
