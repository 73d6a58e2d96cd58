#pragma once
// The profile through the middle of a frame as a table.

#include "engine/model/sensor.h"
#include "host/output/files/channel.h"

namespace pmdsim {

// The row that profiles show: the middle one, of an even number the lower of the middle two.
std::uint32_t profile_row(const glm::uvec2 &resolution);

// One line a column after a header line: column, chip_x_m (the pixel's centre on the chip), angle_deg (its
// ray against the optical axis, seen from above), then the channels. Throws Error (output).
void write_profile_csv(OutputFile &file, const ChannelSet &channels, const Sensor &sensor);

} // namespace pmdsim
