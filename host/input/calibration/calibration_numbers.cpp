#include "host/input/calibration/calibration_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

TextPlace place_of(const YAML::Node &node, const std::filesystem::path &file) {
  const YAML::Mark mark = node.Mark();
  return {file, static_cast<std::size_t>(mark.line) + 1, static_cast<std::size_t>(mark.column) + 1};
}

double number_of(const YAML::Node &node, const CalibrationKey &key) {
  if (!node.IsScalar())
    throw input_error(key, "expected a number");
  const std::string &text = node.Scalar();
  double number = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    throw input_error(key, fmt::format("expected a finite number, found {}", in_quotes(text)));
  return number;
}

// As long as the matrix says.
YAML::Node data_of(const CalibrationEntry &matrix) {
  const CalibrationMap map(matrix.value, matrix.key.place.file);
  const CalibrationEntry data = map.at({"data"});
  const auto rows = map.find({"rows"}), columns = map.find({"cols"});
  if (!data.value.IsSequence())
    throw input_error(data.key, "expected a list of numbers");
  if (rows && columns && number_of(*rows) * number_of(*columns) != static_cast<double>(data.value.size()))
    throw input_error(data.key, fmt::format("expected rows x cols = {} x {} numbers, found {}",
                                            number_of(*rows), number_of(*columns), data.value.size()));
  return data.value;
}

} // namespace

CalibrationMap::CalibrationMap(const YAML::Node &map, std::filesystem::path file)
    : map_(map), file_(std::move(file)) {}

std::optional<CalibrationEntry> CalibrationMap::find(const std::vector<std::string> &names) const {
  std::optional<CalibrationEntry> found;
  for (const auto &member : map_) {
    if (!member.first.IsScalar() || std::ranges::find(names, member.first.Scalar()) == names.end())
      continue;
    const CalibrationKey key{member.first.Scalar(), place_of(member.first, file_)};
    if (found)
      throw input_error(
          key, fmt::format("expected once, found {} in line {} too", found->key.name, found->key.place.line));
    found = CalibrationEntry{key, member.second};
  }
  return found;
}

CalibrationEntry CalibrationMap::at(const std::vector<std::string> &names) const {
  if (auto found = find(names))
    return *found;
  const std::vector<std::string> others(names.begin() + 1, names.end());
  const std::string spellings = others.empty() ? "" : fmt::format(" (or {})", fmt::join(others, ", "));
  throw input_error(Place{file_}, fmt::format("missing key {}{}", names.front(), spellings));
}

std::string text_of(const CalibrationEntry &entry) {
  if (!entry.value.IsScalar())
    throw input_error(entry.key, "expected a text");
  return entry.value.Scalar();
}

double number_of(const CalibrationEntry &entry) { return number_of(entry.value, entry.key); }

std::vector<double> numbers_of(const CalibrationEntry &entry, std::size_t most) {
  const YAML::Node list = entry.value.IsMap() ? data_of(entry) : entry.value;
  if (!list.IsSequence())
    throw input_error(entry.key, "expected numbers: a list, or a matrix with rows, cols and data");
  std::vector<double> numbers;
  const auto add = [&](const YAML::Node &node) {
    if (numbers.size() == most)
      throw input_error(entry.key, fmt::format("expected at most {} numbers", most));
    numbers.push_back(number_of(node, entry.key));
  };
  for (const auto &row : list) {
    if (row.IsSequence())
      std::for_each(row.begin(), row.end(), add);
    else
      add(row);
  }
  return numbers;
}

} // namespace pmdsim
