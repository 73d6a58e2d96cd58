#pragma once
// Channels in a reader's words: titles, groups, and how their values become colours.

#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

// How a page colours a channel: as previews do (ColourScale in engine/model/channels.h), or a colour for each
// number.
enum class PageScale { sequential, zero_centred, turn, share, ids, bits };

// What is left out last, next to last and first where a page would be too large: the raw channels are those
// of the camera's single images, the secondary ones say in other words, or without noise, what others say.
enum class ChannelRank { main, secondary, raw };

struct ChannelWords {
  std::string quantity;                 // the name in files without the prefix of a frequency: "tap3"
  std::optional<std::size_t> frequency; // of several
  std::string title;                    // "distance", "tap 3"
  std::string group;                    // "Measured", "Ground truth", ...
  std::string about;                    // what it is, in a line; "" where nobody knows
  std::string none;                     // what a value that is no number means: "no return"
  PageScale scale;
  ChannelRank rank;
  std::size_t at; // place in lists: the lower the earlier
};

// Any name will do: what nobody knows is called by its name and coloured as `is_integer` says.
ChannelWords words_of(std::string_view channel_name, bool is_integer);

// The same of a frame that `correct` left, which has its own range_m and z_m.
ChannelWords corrected_words_of(std::string_view channel_name, bool is_integer);

// As the page's scripts have them: "sequential".
std::string_view scale_name(PageScale scale);

} // namespace pmdsim
