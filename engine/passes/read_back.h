#pragma once
// The read-back: a strip's channels from the device into the measurement.

#include "engine/measurement.h"
#include "engine/passes/strip_buffers.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pmdsim {

// Ground truth that has no channels: of one sample a pixel, the host finds it in the sample's record.
struct TruthOfRecords {
  std::vector<std::uint32_t> object_of_shape;
  bool has_fp64; // else a depth is a pair of floats
};

// A frame of the sensor's size, to be filled, in `memory`, whatever that holds.
Measurement make_measurement(const Sensor &sensor, const Signal &signal, const SimulatorOptions &options,
                             Measurement &&memory);

// Copies what the resolve pass (and, if kept, the visibility pass) left to memory that the host can read.
void record_read_back(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                      const StripBuffers &buffers, const Signal &signal);

// Once that is done: copies it to its place in the frame. Throws Error: input where light is beyond what a
// float holds.
void store_strip(const shader::Strip &strip, const StripBuffers &buffers, const Sensor &sensor,
                 const Signal &signal, const std::optional<TruthOfRecords> &truth, Measurement &measurement);

// Of all strips since it was cleared, as read back last; only where Signal::promised.
shader::BrokenPromise broken_promise(const StripBuffers &buffers);

} // namespace pmdsim
