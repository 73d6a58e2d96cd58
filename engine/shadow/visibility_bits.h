#pragma once
// Which diodes reach which sample, read back in the order of the frame's samples and of the illuminators'
// diodes.

#include "engine/light/source_windows.h"
#include "engine/model/measurement.h"
#include "engine/model/sensor.h"
#include "engine/sampling/strip_memory.h"

#include <vector>

namespace pmdsim {

// Every bit 0.
std::vector<std::uint32_t> no_visibility(const Sensor &sensor, const SourceGroups &groups);

// Sets the bits of all diodes of all samples in `to`, where there are any.
void full_visibility(const SourceGroups &groups, std::vector<std::uint32_t> &to);

// Copies a window's bits to memory that the host can read.
void record_visibility(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                       const StripBuffers &buffers, const SourceWindow &window);

// Once that is done: sets the bits of the window's diodes in `to`, those of samples that see nothing as well.
// `row_by_row`: the samples lie so, as depth records do.
void store_visibility(const shader::Strip &strip, const StripBuffers &buffers, const SourceWindow &window,
                      const SourceGroups &groups, bool row_by_row, std::vector<std::uint32_t> &to);

// Clears the bits of samples that see nothing (sample_pixel_id is 0).
void clear_unseen(Measurement &measurement);

} // namespace pmdsim
