#include "host/input/gltf/placement.h"

namespace pmdsim {

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
