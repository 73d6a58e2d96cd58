#pragma once
// A calibration file as YAML, and the JSON that is also YAML, from untrusted files: of bounded depth and
// size, errors in one line; its keys, texts and numbers.

#include "host/input/calibration/calibration_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace pmdsim {

inline constexpr std::size_t max_yaml_values = 250'000; // keys, numbers, texts, lists and maps

// The first document of the text. OpenCV's "%YAML:1.0" may stand before it. Throws Error (input):
// "FILE:LINE:COLUMN: ...".
YAML::Node parse_yaml(const std::string &text, const std::filesystem::path &file);

struct CalibrationEntry {
  CalibrationKey key;
  YAML::Node value;
};

class CalibrationMap {
public:
  // `map` is a YAML map of `file`; `name` is its key in the file, if it has one.
  CalibrationMap(const YAML::Node &map, std::filesystem::path file);

  // The only key that has one of these names. Throws Error (input) where there are two.
  std::optional<CalibrationEntry> find(const std::vector<std::string> &names) const;
  // As above; throws where there is none.
  CalibrationEntry at(const std::vector<std::string> &names) const;

  const std::filesystem::path &file() const { return file_; }

private:
  YAML::Node map_;
  std::filesystem::path file_;
};

// All throw Error (input) at the entry.

std::string text_of(const CalibrationEntry &entry);
double number_of(const CalibrationEntry &entry); // finite
// Row by row of a list, a list of lists or a matrix {rows, cols, data}; finite, `most` at most.
std::vector<double> numbers_of(const CalibrationEntry &entry, std::size_t most);

} // namespace pmdsim
