#pragma once
// The read-back: from the device into the measurement, a strip's channels and what its samples' IDs or
// records tell.

#include "engine/light/tones.h"
#include "engine/model/measurement.h"
#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim {

// Coverage, z and ids of one sample a pixel, which the host reads off the sample's record; then their
// channels stay empty.
struct TruthOfRecords {
  std::vector<std::uint32_t> object_of_shape;
  bool has_fp64; // else a depth is a pair of floats
};

// A frame of the sensor's size, to be filled, in `memory`, whatever that holds.
Measurement make_measurement(const Sensor &sensor, const Modulation &modulation,
                             const SimulatorOptions &options, Measurement &&memory);

// Who writes the light to its place in the frame: amplitude, phase, distance and mean radiance.
enum class LightBy { read_back, electrons };

// Copies what the demodulation (and, where the host reads them, the ID raster) left to memory that the
// host can read, and then to its place in the frame. Storing throws Error: input where light is beyond what a
// float holds.
Pass read_back_pass(const Sensor &sensor, const Modulation &modulation, const StripBuffers &buffers,
                    const std::optional<TruthOfRecords> &truth, LightBy light = LightBy::read_back);

// The violations of all strips since they were cleared, as last read; only where Modulation::keeps_terms.
shader::BudgetViolations budget_violations(const StripBuffers &buffers);

} // namespace pmdsim
