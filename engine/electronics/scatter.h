#pragma once
// Light that is scattered inside the camera, between lens and chip: each pixel gets a part of what the others
// should have got (docs/theory.md, "Scatter inside the camera"). By the host on any device.

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <vector>

namespace pmdsim {

// Convolves the complex returns, the taps where they are there, and the mean radiance of a frame of a sensor
// with Sensor::scatter; what would fall beside the chip is lost. Channels without bounces stay as they are.
// Adds the pass "scatter" to the frame's times.
void scatter(const Sensor &sensor, Measurement &frame);

// The same of a frame whose taps were exposed one by one, each with a mean radiance of its own, frequency by
// frequency (none without electronics); the other channels follow from the taps, and the frame's mean
// radiance is the first tap's.
void scatter_taps(const Sensor &sensor, std::vector<std::vector<float>> &mean_radiance, Measurement &frame);

} // namespace pmdsim
