#pragma once
// Frames of the same run that lie in several folders, as processes leave them that share the work but no
// folder, brought together in one.

#include "engine/model/warning.h"
#include "host/output/run/frame_range.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

struct MergeRequest {
  std::vector<std::filesystem::path> sources;
  std::filesystem::path into;
  std::optional<FrameRange> frames; // instead of all of the setup's
};

struct Merged {
  std::string run_hash;
  std::size_t frames = 0;
  std::size_t linked = 0, copied = 0; // files of frames
  std::optional<Warning> left{};      // RunFolder::left_warning() of where they are now
};

// Files are hard links where the file system can, else copies. A frame that is in several folders is taken
// from the first, where all have files of the same sizes. Existing outputs are replaced, as a run replaces
// them. `check` is called now and then; what it throws comes out, and whole frames stay with a manifest of
// them. Throws Error: (input) where a folder has no run or another one than the first, or frames are missing,
// and then nothing is written; (usage) where `frames` goes beyond the setup's or `into` is one of the
// sources; (output).
Merged merge_runs(const MergeRequest &request, const std::function<void()> &check);

} // namespace pmdsim
