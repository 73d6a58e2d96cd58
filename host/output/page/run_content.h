#pragma once
// What a finished run has left in its directory, as a page shows it: its manifest, and which file has the
// channels of which frame. Files are untrusted.

#include "host/output/run/frame_range.h"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// One sensor's frame.
struct PageFrame {
  std::uint32_t number = 0;
  nlohmann::ordered_json entry{}; // the manifest's
  std::filesystem::path file{};   // with its channels
};

struct PageSensor {
  std::string name;
  std::vector<PageFrame> frames; // at least one, in the order of the manifest
};

struct RunContent {
  std::filesystem::path directory;
  nlohmann::ordered_json head; // the manifest without its frames
  std::vector<PageSensor> sensors;
};

// Of all frames, or of those in the range. Throws Error (input): the directory has no manifest, or one that
// no run has written; a frame has no file that read_frame() reads, and then it says which formats it needs;
// the manifest tells of no frame, or of none in the range.
RunContent read_run(const std::filesystem::path &directory, const std::optional<FrameRange> &frames);

// What the record of a frame says of one sensor beyond the manifest: frame_ms, passes_ms, told, as far as
// they are there; an empty object where the record has gone.
nlohmann::ordered_json times_of(const RunContent &run, const std::string &sensor, std::uint32_t frame);

} // namespace pmdsim
