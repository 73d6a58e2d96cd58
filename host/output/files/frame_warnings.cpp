#include "host/output/files/frame_warnings.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {

void FrameWarnings::add(const Warning &warning, std::uint32_t frame) {
  const auto known = std::ranges::find_if(all_, [&](const OfFrames &each) {
    return each.warning.code == warning.code && each.warning.place == warning.place;
  });
  if (known == all_.end()) {
    all_.push_back({warning, frame, frame, 1});
  } else if (known->last != frame) {
    known->last = frame;
    ++known->count;
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
