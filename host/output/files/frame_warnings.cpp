#include "host/output/files/frame_warnings.h"

#include <fmt/format.h>

namespace pmdsim {

void FrameWarnings::add(const Warning &warning, std::uint32_t frame) {
  const auto [place, is_new] = place_of_.try_emplace({warning.code, warning.place}, all_.size());
  if (is_new) {
    all_.push_back({warning, frame, frame, 1});
  } else if (OfFrames &known = all_[place->second]; known.last != frame) {
    known.last = frame;
    ++known.count;
  }
}

std::vector<Warning> FrameWarnings::merged() const {
  std::vector<Warning> merged;
  for (const auto &[warning, first, last, count] : all_) {
    merged.push_back(warning);
    merged.back().place += fmt::format(", frame {}", first);
    if (count > 1)
      merged.back().text += fmt::format("; the same of {} frame{} more, up to frame {}", count - 1,
                                        count == 2 ? "" : "s", last);
  }
  return merged;
}

} // namespace pmdsim
