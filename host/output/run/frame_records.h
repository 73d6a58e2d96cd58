#pragma once
// A file beside the outputs of each frame, written last: that the frame is whole, what a manifest says of it,
// and what is only so this time. "0007.record.json" of frame 7:
//   {"frame": 7, "run": the run's hash, "host": name, "sensors": for each
//      {"manifest": its entry there, "frame_ms", "passes_ms", "check_ms", "bytes": of each output,
//       "told": what the command says beyond that, if anything,
//       "thumbnails": of frames that pictures of the whole run show (host/output/sheets/thumbnail.h)}}

#include "host/output/files/manifest.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

std::string record_name(std::uint32_t frame);

// Of all sensors' parts of one frame.
nlohmann::ordered_json record_json(const std::string &run_hash, const std::vector<FrameRecord> &parts);

// Nothing where there is none, or one of another run, or not the whole of one. What comes has all that is
// asked of it here and by told_json(), and names no files but that frame's. Throws Error (input) where it
// cannot be read or is no regular file.
std::optional<nlohmann::ordered_json> read_record(const std::filesystem::path &folder, std::uint32_t frame,
                                                  const std::string &run_hash);

// Whether the outputs that it names are there, each of its size. Throws Error (output) where the system does
// not tell.
bool has_its_files(const std::filesystem::path &folder, const nlohmann::ordered_json &record);

// Whether it has warnings, or pixels that may be off by more than was asked for.
bool has_warnings(const nlohmann::ordered_json &record);

// The numbers of the frames that have a record of whichever run, sorted.
std::vector<std::uint32_t> recorded_frames(const std::filesystem::path &folder);

// Of a record's sensor: sensor, frame, time_s, frame_ms, passes_ms, mode and the other keys of
// accuracy_json(), bounces, if any. As `render --json` tells it.
nlohmann::ordered_json told_json(const nlohmann::ordered_json &of_sensor);

} // namespace pmdsim
