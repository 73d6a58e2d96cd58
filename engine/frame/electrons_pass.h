#pragma once
// The electrons of a strip, from the light that its other passes leave in the channels.

#include "engine/light/tones.h"
#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"

namespace pmdsim {

// Counts them on the host, on any device; behind the read-back, which leaves the light to it. Storing throws
// Error: input where light is beyond what a float holds.
Pass electrons_pass(const Sensor &sensor, const Modulation &modulation, const SimulatorOptions &options,
                    const StripBuffers &buffers);

} // namespace pmdsim
