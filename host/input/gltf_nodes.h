#pragma once
// The node tree of a glTF file's active scene, flattened, with its transforms in double precision.

#include "host/input/input_error.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
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

struct SceneNode {
  std::size_t index; // in the file's /nodes
  AffineTransform world_from_node;
};

// Every node of the active scene (`scene`, else the first; none where the file has no scenes), parents before
// their children. Throws Error (input): a cycle, a node with two parents, a transform that is not finite or
// not affine.
std::vector<SceneNode> active_nodes(const tinygltf::Model &model, const Place &root);

} // namespace pmdsim
