#pragma once
// Channels by the names that they have in files.

#include "engine/model/channels.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

// A name taken apart: "f1.tap_a_e3" is the row "tap_a_e" of frequency 1, tap 3.
struct ChannelName {
  const ChannelRow *row; // null where no row has the name
  std::optional<std::size_t> frequency, tap;
};

// A prefix only where the row is of a frequency, a number behind it only where it is of taps.
ChannelName channel_named(std::string_view name);

// The channel of floats that has what rounding took from a channel of distances, where a file knows no
// double: "distance_rest_m" of "distance_m".
std::string rest_name(std::string_view name);
// The other way round; nothing where the name is none of a rest.
std::optional<std::string> name_of_rest(std::string_view name);

} // namespace pmdsim
