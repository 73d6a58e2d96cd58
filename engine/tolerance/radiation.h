#pragma once
// Radiation laws with their slopes. Diagrams are linear between the directions of their tables, so that their
// slope jumps there.

#include "engine/model/illuminator.h"

namespace pmdsim {

struct Radiation {
  double value;     // J
  glm::dvec3 slope; // dJ is its product with a change of the direction, which is across the direction
};

// J of a diode towards `direction`, unit length, in the frame of its axis. On the axis itself, and opposite,
// a diagram has no slope.
Radiation radiation(const Diode &diode, const glm::dvec3 &direction);

} // namespace pmdsim
