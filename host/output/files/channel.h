#pragma once
// The channels of a frame as files name them (README.md, "Outputs").

#include "engine/model/measurement.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pmdsim {

// "distance_m", of the frequency 1 of several "f1.distance_m".
std::string channel_name(const std::string &quantity, const std::optional<std::size_t> &frequency);

// A view: row-major, row 0 at the top, rows * columns values that outlive it. Floats hold NaN where nothing
// was measured, ids no_id.
struct Channel {
  std::string quantity; // "distance_m"
  std::string unit;     // "" for ids and ratios
  std::variant<std::span<const float>, std::span<const std::uint32_t>> values;
  std::optional<std::size_t> frequency = std::nullopt; // index of the one that it belongs to, of several

  std::string name() const { return channel_name(quantity, frequency); }
};

// Channels of one size.
struct ChannelSet {
  glm::uvec2 resolution{0, 0}; // columns, rows
  std::vector<Channel> channels;
};

// Channel::frequency of what belongs to the frequency `index` of `count`.
std::optional<std::size_t> frequency_of(std::size_t index, std::size_t count);

// amplitude, phase_rad, distance_m of every frequency; tap0, tap1, ... of every frequency where they are
// filled; range_m, z_m, coverage, lit where it is filled, triangle_id, object_id. Views into `measurement`.
ChannelSet channels_of(const Measurement &measurement);

} // namespace pmdsim
