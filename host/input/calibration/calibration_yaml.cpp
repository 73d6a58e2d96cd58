#include "host/input/calibration/calibration_yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <yaml-cpp/eventhandler.h>

namespace pmdsim {
namespace {

// Ends the parsing of a document that would take too much memory as a tree. An alias counts once, as it takes
// the memory of one.
class ValueCount final : public YAML::EventHandler {
public:
  void OnDocumentStart(const YAML::Mark &) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark &mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark &mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark &mark, const std::string &, YAML::anchor_t, const std::string &) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

private:
  void count(const YAML::Mark &mark) {
    if (++values_ > max_yaml_values)
      throw YAML::ParserException(mark, fmt::format("more than {} values", max_yaml_values));
  }

  std::size_t values_ = 0;
};

std::string reason(const YAML::Exception &error) {
  if (error.msg == YAML::ErrorMsg::BAD_FILE) // yaml-cpp's name for what is nested deeper than it follows
    return "nested too deep";
  std::string text = error.msg; // may quote a byte that is no text
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

TextPlace place_of(const YAML::Mark &mark, const std::filesystem::path &file) {
  return {file, static_cast<std::size_t>(mark.line) + 1, static_cast<std::size_t>(mark.column) + 1};
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

YAML::Node parse_yaml(const std::string &text, const std::filesystem::path &file) {
  try {
    std::istringstream in(text);
    ValueCount count;
    YAML::Parser(in).HandleNextDocument(count);
    return YAML::Load(text);
  } catch (const YAML::Exception &error) {
    const std::string message = "not valid YAML or JSON: " + reason(error);
    throw error.mark.is_null() ? input_error(Place{file}, message)
                               : input_error(place_of(error.mark, file), message);
  }
}

CalibrationMap::CalibrationMap(const YAML::Node &map, std::filesystem::path file)
    : map_(map), file_(std::move(file)) {}

std::optional<CalibrationEntry> CalibrationMap::find(const std::vector<std::string> &names) const {
  std::optional<CalibrationEntry> found;
  for (const auto &member : map_) {
    if (!member.first.IsScalar() || std::ranges::find(names, member.first.Scalar()) == names.end())
      continue;
    const CalibrationKey key{member.first.Scalar(), place_of(member.first.Mark(), file_)};
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

double number_of(const CalibrationEntry &entry) {
  if (!entry.value.IsScalar())
    throw input_error(entry.key, "expected a number");
  const std::string &text = entry.value.Scalar();
  double number = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    throw input_error(entry.key, fmt::format("expected a finite number, found {}", in_quotes(text)));
  return number;
}

std::vector<double> numbers_of(const CalibrationEntry &entry, std::size_t most) {
  const YAML::Node list = entry.value.IsMap() ? data_of(entry) : entry.value;
  if (!list.IsSequence())
    throw input_error(entry.key, "expected numbers: a list, or a matrix with rows, cols and data");
  std::vector<double> numbers;
  const auto add = [&](const YAML::Node &node) {
    if (numbers.size() == most)
      throw input_error(entry.key, fmt::format("expected at most {} numbers", most));
    numbers.push_back(number_of({entry.key, node}));
  };
  for (const auto &row : list)
    if (row.IsSequence())
      std::for_each(row.begin(), row.end(), add);
    else
      add(row);
  return numbers;
}

} // namespace pmdsim
