#pragma once
// Measured radiation diagrams: J between the directions of a table.

#include "engine/model/illuminator.h"

#include <numbers>

namespace pmdsim::reference {

inline constexpr double full_turn_rad = 2.0 * std::numbers::pi;

// J of a diode whose pattern is a diagram, towards `direction` (of any length but 0, in the frame of the
// diode's axis).
double diagram_gain(const Diode &diode, const glm::dvec3 &direction);

// The integral of J over all directions, of what is linear between those of the table.
double diagram_solid_angle_sr(const Diagram &diagram);

} // namespace pmdsim::reference
