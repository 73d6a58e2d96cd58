#pragma once
// Every bit of one frame, to tell two frames apart.

#include "engine/model/measurement.h"
#include "engine/simulator.h"

#include <string>
#include <vector>

namespace pmdsim::test {

std::string bytes_of(const Measurement &measurement);

// The repeatability frames' names, which say what each frame has beyond a pinhole and a sine without shadows
// in mode exact.
const std::vector<std::string> &repeatability_frames();

struct RepeatabilityFrame {
  Scene scene;
  Sensor sensor;
  Illuminator illuminator;
  Shadows shadows;
  Accuracy accuracy;
};

// A random scene of 256 x 192 pixels with 1 x 1 to 3 x 3 samples each and 30 diodes. Throws std::out_of_range
// where there is no such frame.
RepeatabilityFrame repeatability_frame(const std::string &name);

// All that a simulator gives.
SimulatorOptions keep_everything(std::uint32_t max_strip_samples = 0);

Measurement measure(Simulator &simulator, const RepeatabilityFrame &frame);

} // namespace pmdsim::test
