#pragma once
// Radiation laws, J of the paper's eq. 5, as they are defined; diagrams are linear between the directions of
// the table.

#include "engine/model/illuminator.h"

namespace pmdsim::reference {

// J of a diode towards a point from which `to_diode_m` leads to it, `range_m` long, in the frame of its axis.
double radiation(const Diode &diode, const glm::dvec3 &to_diode_m, double range_m);

} // namespace pmdsim::reference
