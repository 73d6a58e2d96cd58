#pragma once
// What a sensor's electronics make of light: the photon transfer, and the precision of distances. Predictions
// stand beside what simulated frames show.

#include "host/input/setup/setup.h"
#include "host/output/tables/noise.h"

#include <functional>
#include <vector>

namespace pmdsim {

// Of each sensor with electronics and each of its frequencies, at the setup's start. `progress` may throw to
// stop. Throws Error (input) where no sensor has electronics.
std::vector<NoiseStudy> study_noise(const Setup &setup, const std::function<void(double)> &progress);

} // namespace pmdsim
