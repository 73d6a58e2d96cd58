#pragma once
// Which frames of a setup a run is asked for.

#include <cstddef>
#include <cstdint>

namespace pmdsim {

// Frames `first`, `first` + `step`, ... below `end`.
struct FrameRange {
  std::uint32_t first = 0, end = 1, step = 1;

  std::uint32_t count() const { return first < end ? (end - first - 1) / step + 1 : 0; }
  std::uint32_t at(std::size_t index) const { return first + static_cast<std::uint32_t>(index) * step; }
  std::uint32_t index_of(std::uint32_t frame) const { return (frame - first) / step; } // it contains it
  bool contains(std::uint32_t frame) const {
    return frame >= first && frame < end && (frame - first) % step == 0;
  }
};

// One of several parts of the work: the frames whose number modulo `count` is `index`.
struct Shard {
  std::uint32_t index = 0, count = 1;

  // Its frames of `range`, whose step is 1.
  FrameRange of(const FrameRange &range) const {
    const std::uint32_t past = range.first % count;
    const std::uint32_t ahead = index >= past ? index - past : count - (past - index);
    return ahead < range.end - range.first ? FrameRange{range.first + ahead, range.end, count}
                                           : FrameRange{range.end, range.end, count};
  }
};

} // namespace pmdsim
