#pragma once
// YAML text, and the JSON that is also YAML, from untrusted files: of bounded depth and size, errors in one
// line.

#include <filesystem>
#include <string>
#include <yaml-cpp/yaml.h>

namespace pmdsim {

inline constexpr std::size_t max_yaml_values = 250'000; // keys, numbers, texts, lists and maps

// The first document of the text. OpenCV's "%YAML:1.0" may stand before it. Throws Error (input):
// "FILE:LINE:COLUMN: ...".
YAML::Node parse_yaml(const std::string &text, const std::filesystem::path &file);

} // namespace pmdsim
