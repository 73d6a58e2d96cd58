#pragma once
// The rays of a sensor's samples: chip pose (the paper's eq. 1), thin lens, distortion and vignetting, in
// double.

#include "engine/model/sensor.h"

#include <functional>
#include <glm/glm.hpp>
#include <optional>

namespace pmdsim::reference {

class LensModel {
public:
  explicit LensModel(const Sensor &sensor);

  // Unit vector from the lens through sample `sample` (column, row in 0 ... S * resolution - 1); nothing
  // where the sample sees nothing because its place lies behind the lens or beyond the distortion's fold.
  std::optional<glm::dvec3> sample_ray(const glm::uvec2 &sample) const;

  // The factor by which a ray (unit length) counts.
  double vignetting_gain(const glm::dvec3 &ray) const;

private:
  Sensor sensor_;
  glm::dmat3 chip_rotation_;
  glm::dvec3 origin_m_; // of the chip's frame
  // The ray, not normalised, to a place in front of the lens (z > 0), on the branch that begins at the
  // optical axis; nothing where that branch folds before it.
  std::function<std::optional<glm::dvec3>(const glm::dvec3 &place_m)> ray_to_;
};

} // namespace pmdsim::reference
