#pragma once
// The channels of a frame as files name them (README: "What is written").

#include "engine/measurement.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pmdsim {

// A view: row-major, row 0 at the top, rows * columns values that outlive it. Floats hold NaN where nothing
// was measured, ids no_id.
struct Channel {
  std::string name;
  std::string unit; // "" for ids and ratios
  std::variant<std::span<const float>, std::span<const std::uint32_t>> values;
};

// Channels of one size.
struct ChannelSet {
  glm::uvec2 resolution{0, 0}; // columns, rows
  std::vector<Channel> channels;
};

// amplitude, phase_rad, distance_m, range_m, z_m, coverage, triangle_id, object_id; views into `measurement`.
ChannelSet channels_of(const Measurement &measurement);

} // namespace pmdsim
