#pragma once
// The rays of a sensor's samples: chip pose (the paper's eq. 1), thin lens, distortion and vignetting, in
// double.

#include "engine/model/sensor.h"
#include "engine/reference/view/distortion.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <variant>

namespace pmdsim::reference {

class LensModel {
public:
  explicit LensModel(const Sensor &sensor);

  // Unit vector from the lens through sample `sample` (column, row in 0 ... S * resolution - 1); nothing
  // where the sample sees nothing because its place lies behind the lens or beyond the distortion's fold.
  std::optional<glm::dvec3> sample_ray(const glm::uvec2 &sample) const;

  // Chip coordinates x', y' of a sample.
  glm::dvec2 sample_on_chip_m(const glm::uvec2 &sample) const;
  // Where a place x', y' of the chip, seen in front of the lens, lies in the camera's frame.
  glm::dvec3 place_m(const glm::dvec2 &chip_m) const {
    return origin_m_ + chip_rotation_ * glm::dvec3(chip_m, 0.0);
  }
  // The slopes under which a ray meets the chip: the inverse of sample_ray(), which is x/z and y/z of the
  // place where it does.
  std::optional<glm::dvec2> slopes(const glm::dvec3 &ray) const;

  // What a ray (unit length) counts.
  double vignetting_gain(const glm::dvec3 &ray) const;

private:
  glm::dvec2 resolution_, pitch_m_, fill_factor_;
  std::uint32_t samples_;
  glm::dmat3 chip_rotation_;
  glm::dvec3 origin_m_; // of the chip's frame
  std::variant<PinholeLens, BrownConradyLens, FisheyeLens> lens_;
  Vignetting vignetting_;
};

} // namespace pmdsim::reference
