#pragma once
// What of a run a page has room for.

#include "host/output/page/channel_words.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim {

// Every `frame_step`-th frame from the first on, and of these every `pixel_step`-th pixel of every
// `pixel_step`-th row: values of the files, never means. Channels of a rank beyond `rank` are left out.
struct PagePlan {
  std::uint32_t frame_step = 1, pixel_step = 1;
  ChannelRank rank = ChannelRank::raw;

  bool has(ChannelRank of) const { return of <= rank; }
  bool operator==(const PagePlan &) const = default;
};

// What one sensor's frames would take, in bytes of the page.
struct SensorSize {
  std::size_t frames = 0, columns = 0, rows = 0;
  std::array<double, 3> bytes{}; // of one whole frame, by the channels' ranks
};

// The plan that leaves out least, of those of at most `max_bytes`: first channels go, rank by rank, then
// frames down to 16, then pixels. The smallest there is where none fits.
PagePlan plan_for(const std::vector<SensorSize> &sensors, double max_bytes);

// Names of the channels that a run has, by their ranks.
using ChannelsByRank = std::array<std::vector<std::string>, 3>;

// What the plan leaves out, a sentence each.
std::vector<std::string> left_out_text(const PagePlan &plan, std::size_t frames,
                                       const ChannelsByRank &channels);

} // namespace pmdsim
