#pragma once
// The JSON files of a run's folder as they are read again: anyone may have edited them.

#include "host/input/file/json_file.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pmdsim {

// Of run.json and of a record: more than a setup of the largest size gives.
inline constexpr std::size_t max_run_json_bytes = std::size_t{1} << 27;
// Of a manifest: as 100,000 frames of six sensors have.
inline constexpr std::size_t max_manifest_bytes = std::size_t{1} << 30;
inline constexpr std::size_t max_manifest_values = std::size_t{1} << 26;

// Unlike parse_json()'s, keys stay in their order and numbers as they are written, so that a manifest that is
// made of them has the same bytes each time. Nothing where the text is no JSON, nested deeper than
// max_json_depth or of more than `max_values`. Throws Error (out_of_memory) at `file` where there is no room
// for the values.
std::optional<nlohmann::ordered_json> parsed_in_order(const std::string &text,
                                                      const std::filesystem::path &file,
                                                      std::size_t max_values = max_json_values);

} // namespace pmdsim
