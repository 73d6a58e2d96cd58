#pragma once
// J of the paper's eq. 5 in double, for bounds. The sums have their own (engine/light/host/laws.h).

#include "engine/model/illuminator.h"

namespace pmdsim {

// `way`: from the diode, of any length, in the frame of its axis.
double radiation(const Diode &diode, const glm::dvec3 &way);

} // namespace pmdsim
