#pragma once
// Pictures of a whole run of several frames: SENSOR.CHANNEL.sheet.png, its frames side by side, and
// SENSOR.CHANNEL.apng, the same one after the other. They show at most 36 frames, evenly over the run, and
// are made of what the frames' records keep, so that it does not matter who has made which frame, or when.

#include "host/output/files/channel.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// Whether these pictures show that frame of so many.
bool is_in_sheets(std::uint32_t frame, std::uint32_t frame_count);
// What the record of such a frame keeps.
nlohmann::ordered_json thumbnails_json(const ChannelSet &channels);

// Makes them of the run in the folder; none where a frame that they show is missing or keeps nothing, or
// the run has one frame alone. Returns their names. `check` is called now and then; what it throws comes out.
// Throws Error: (input) where the folder has no run; (output).
std::vector<std::string> write_sheets(const std::filesystem::path &folder,
                                      const std::function<void()> &check);

// Those of an earlier run.
void remove_sheets(const std::filesystem::path &folder, const std::string &sensor);

} // namespace pmdsim
