#pragma once
// The same view with fewer pixels, for what the reference can afford.

#include "engine/sensor.h"

namespace pmdsim {

// Columns and rows divided by `factor` (one of each at least), pixels larger in return; a factor up to 1
// changes nothing.
Sensor coarser(Sensor sensor, double factor);

} // namespace pmdsim
