#pragma once
// The light: point-like diodes with a radiation diagram each, plain data in SI units.

#include "engine/model/pose.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

// A measured diagram: J at a grid of directions, linear between them in both angles, 0 at angles to the axis
// below the first and beyond the last.
struct Diagram {
  std::vector<double> theta_rad; // angle to the axis, ascending, 0 to pi; at least one
  std::vector<double> phi_rad;   // about the axis from Diode::across, right-handed, ascending, in [0, 2 pi),
                                 // periodic; a single one: the same all around
  std::vector<double> relative;  // J, >= 0; phi_rad.size() values for each theta in turn
};

// J of the paper's eq. 5, 1 on the axis. `cosine`: max(0, cos theta)^order, for order 0 the half-space in
// front of the diode (the limit of small orders). `isotropic`: 1 everywhere. `diagram`: a table.
struct Pattern {
  enum class Kind { isotropic, cosine, diagram };
  Kind kind = Kind::isotropic;
  double order = 0.0;                               // cosine only, any real >= 0
  std::shared_ptr<const Diagram> diagram = nullptr; // diagram only

  bool operator==(const Pattern &) const = default; // with the same diagram, not one that is equal
};

// A law's name in setups and tables of diodes, and the number that it has there.
struct LawName {
  const char *key;
  double Pattern::*number = nullptr; // nothing: none
};

// In the order of Pattern::Kind.
inline constexpr std::array law_names{LawName{"isotropic"}, LawName{"order", &Pattern::order},
                                      LawName{"file"}};

struct Diode {
  glm::dvec3 position_m{0.0};     // illuminator frame
  glm::dvec3 axis{0.0, 0.0, 1.0}; // illuminator frame, unit length
  double intensity_w_sr = 1.0;    // on the axis, modulated part, damping factor included, >= 0
  Pattern pattern;
  glm::dvec3 across{1.0, 0.0, 0.0}; // illuminator frame, unit length, at right angles to the axis: where a
                                    // diagram's phi is 0

  bool operator==(const Diode &) const = default;
};

struct Illuminator {
  std::string name = "ring";
  Pose world_from_illuminator = node_from_camera(); // illuminator frame: x right, y down, z forward
  std::vector<Diode> diodes;                        // at least one
  double modulation_phase_rad = 0.0;                // added to the phase of every path
  double modulation_depth = 1.0; // the modulated part of the light over its mean, above 0, at most 1

  bool operator==(const Illuminator &) const = default;
};

inline std::size_t diode_count(const std::vector<Illuminator> &illuminators) {
  std::size_t count = 0;
  for (const Illuminator &illuminator : illuminators)
    count += illuminator.diodes.size();
  return count;
}

// One isotropic diode of 1 W/sr at the origin of the given frame: eq. 2 and 3's monostatic light.
inline Illuminator monostatic_illuminator(const Pose &world_from_illuminator) {
  return {"monostatic", world_from_illuminator, {Diode{}}};
}

} // namespace pmdsim
