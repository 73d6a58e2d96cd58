#pragma once
// The light: point-like diodes with a radiation diagram each, plain data in SI units.

#include "engine/pose.h"

#include <string>
#include <vector>

namespace pmdsim {

// J of the paper's eq. 5, 1 on the axis. `cosine`: max(0, cos theta)^order, for order 0 the half-space in
// front of the diode (the limit of small orders). `isotropic`: 1 everywhere.
struct Pattern {
  enum class Kind { isotropic, cosine };
  Kind kind = Kind::isotropic;
  double order = 0.0; // cosine only, any real >= 0
};

struct Diode {
  glm::dvec3 position_m{0.0};     // illuminator frame
  glm::dvec3 axis{0.0, 0.0, 1.0}; // illuminator frame, unit length
  double intensity_w_sr = 1.0;    // on the axis, modulated part, >= 0
  Pattern pattern;
};

struct Illuminator {
  std::string name = "ring";
  Pose world_from_illuminator = node_from_camera(); // illuminator frame: x right, y down, z forward
  std::vector<Diode> diodes;                        // at least one
};

// One isotropic diode of 1 W/sr at the origin of the given frame: eq. 2 and 3's monostatic light.
inline Illuminator monostatic_illuminator(const Pose &world_from_illuminator) {
  return {"monostatic", world_from_illuminator, {Diode{}}};
}

} // namespace pmdsim
