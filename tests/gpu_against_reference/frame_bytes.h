#pragma once
// Every bit of one frame, to tell two frames apart.

#include "engine/measurement.h"
#include "engine/simulator.h"

#include <string>

namespace pmdsim::test {

std::string bytes_of(const Measurement &measurement);

// A random scene of 256 x 192 pixels with 2 x 2 samples each and 30 diodes.
void prepare_repeatability_frame(Simulator &simulator);

} // namespace pmdsim::test
