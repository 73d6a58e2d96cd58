#pragma once
// The JSON files of a run's folder as they are read again: anyone may have edited them.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pmdsim {

// More than a setup of the largest size gives.
inline constexpr std::size_t max_run_json_bytes = std::size_t{1} << 27;

// Unlike parse_json()'s, keys stay in their order and numbers as they are written, so that a manifest that is
// made of them has the same bytes each time. Nothing where the text is no JSON, nested deeper than
// max_json_depth or of more than max_json_values.
std::optional<nlohmann::ordered_json> parsed_in_order(const std::string &text);

} // namespace pmdsim
