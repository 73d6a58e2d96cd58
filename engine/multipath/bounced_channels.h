#pragma once
// From the light that has bounced to a measurement's channels: it is added to the taps that the camera forms
// its phase from (engine/model/measurement.h).

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"
#include "engine/multipath/bounced_image.h"
#include "engine/radiosity/bounce_tones.h"

#include <vector>

namespace pmdsim {

// z of each pixel's direct light, of each tone: that of its frequency, whichever harmonic it is.
std::vector<std::vector<Phasor>> direct_light(const Measurement &measurement,
                                              const std::vector<BounceTone> &tones);

// Fills the channels of multipath, and adds what has bounced to amplitude, phase, distance and taps.
void add_bounced(const BouncedImage &image, const BounceTones &tones, const Sensor &sensor,
                 Measurement &measurement);

// The value that the share `part` of the values, NaN left out, does not exceed; 0 where there are none.
double quantile(const std::vector<float> &values, double part);

} // namespace pmdsim
