#pragma once
// The same view with fewer pixels, for what the reference can afford.

#include "engine/model/sensor.h"

namespace pmdsim {

// Columns and rows divided by `factor`, pixels larger in return; a factor up to 1 changes nothing. At least 8
// of each stay, or all where there are fewer: behind a wide lens the device takes no pixel that sees too
// much.
Sensor coarser(Sensor sensor, double factor);

} // namespace pmdsim
