#pragma once
// One distance from the phases of several frequencies, beyond the ambiguity range of each: the Chinese
// remainder theorem with errors (docs/theory.md, "Unwrapped distances").

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

namespace pmdsim {

// Fills Measurement::unwrapped_distance_m and unwrap_ok of a sensor with Sensor::unwrap_range_m above 0 and
// at least two frequencies. By the host on any device.
void unwrap_distances(const Sensor &sensor, Measurement &frame);

} // namespace pmdsim
