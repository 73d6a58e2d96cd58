#pragma once
// What is odd about a frame that was measured.

#include "engine/model/accuracy.h"
#include "engine/model/measurement.h"
#include "engine/model/sensor.h"
#include "engine/model/warning.h"
#include "host/input/setup/setup.h"

#include <vector>

namespace pmdsim {

// Of a frame of the setup; the place of each is the sensor. What channels that are not there would show is
// not told, nor what the setup's own warnings explain.
std::vector<Warning> frame_warnings(const Setup &setup, const Sensor &sensor, const Measurement &measurement,
                                    const Accuracy &asked);

// Throws Error where there are any: (accuracy) where the first is of the error, else (input). It tells the
// first and how many more there are.
void refuse_warnings(const std::vector<Warning> &warnings);

} // namespace pmdsim
