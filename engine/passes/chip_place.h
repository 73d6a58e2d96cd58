#pragma once
// The chip as the points passes read it.

#include "engine/sensor.h"
#include "shaders/interface.h"

namespace pmdsim {

// True where the samples lie evenly over an upright chip in its nominal place: then their rays are multiples
// of one slope.
bool is_plain(const Sensor &sensor);

shader::ChipPlace chip_place(const Sensor &sensor);

} // namespace pmdsim
