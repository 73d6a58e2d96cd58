#pragma once
// How steep a measured diagram is: what rounding the direction to a point may do to its light.

#include "engine/model/illuminator.h"

namespace pmdsim {

// What J changes by, at most, where each angle is off by a part of itself, over that part: pi |dJ/dtheta| +
// |dJ/dphi| / sin theta, the latter as directions near the axis are uncertain in phi. Infinite where J varies
// about the axis itself. Where a table ends it may jump to 0; that is an edge like a shadow's.
double diagram_slope(const Diagram &diagram);

} // namespace pmdsim
