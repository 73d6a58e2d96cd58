#include "host/input/diagram/diagram_table.h"
#include "host/input/file/input_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";
constexpr std::string_view delimiters = " \t\r\v\f\n,";

// A text that is read line by line, then number by number, whatever lines they are on.
class IesText {
public:
  IesText(std::filesystem::path file, std::string_view text)
      : file_(std::move(file)), rest_(text.substr(0, text.find('\x1a'))) {} // DOS's end of a file

  // Without the blanks around it; nothing at the end.
  std::optional<std::string_view> next_line() {
    if (rest_.empty())
      return std::nullopt;
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    place_line_ = next_line_;
    take(std::min(line.size() + 1, rest_.size()));
    const std::size_t begin = std::min(line.find_first_not_of(blanks), line.size());
    return line.substr(begin, line.find_last_not_of(blanks) + 1 - begin);
  }

  double number(std::string_view what, NumberRange range = {}) {
    const std::string_view word = next_word();
    if (word.empty())
      throw input_error(here(), fmt::format("{}: expected a number, found the end of the file", what));
    return number_of(word, what, here(), range);
  }
  std::size_t count(std::string_view what, NumberRange range) {
    const double value = number(what, range);
    if (value != std::floor(value))
      throw input_error(here(), fmt::format("{}: expected a whole number, found {}", what, value));
    return static_cast<std::size_t>(value);
  }

  void expect_end() {
    const std::string_view more = next_word();
    if (!more.empty())
      throw input_error(here(),
                        fmt::format("expected the end of the file after the last candela value, found {}",
                                    in_quotes(more)));
  }

  // The place of what was read last.
  TextPlace here() const { return {file_, place_line_}; }

private:
  void take(std::size_t length) {
    next_line_ += static_cast<std::size_t>(std::ranges::count(rest_.substr(0, length), '\n'));
    rest_.remove_prefix(length);
  }

  // Empty at the end.
  std::string_view next_word() {
    take(std::min(rest_.find_first_not_of(delimiters), rest_.size()));
    place_line_ = next_line_;
    const std::string_view word = rest_.substr(0, rest_.find_first_of(delimiters));
    take(word.size());
    return word;
  }

  std::filesystem::path file_;
  std::string_view rest_;
  std::size_t next_line_ = 1;
  std::size_t place_line_ = 1;
};

constexpr NumberRange angle_counts{1.0, static_cast<double>(max_diagram_values)};

// Skips the label up to and with its last line, TILT=..., whatever is in it: only files of 1991 and later
// begin with a line that names the standard, and have keywords. Returns what TILT is.
std::string_view skip_label(IesText &text) {
  constexpr std::string_view tilt = "TILT=";
  while (const auto line = text.next_line()) {
    if (!line->starts_with(tilt))
      continue;
    if (line->size() == tilt.size())
      throw input_error(text.here(), "expected NONE, INCLUDE or a file's name after TILT=");
    const std::string_view value = line->substr(tilt.size());
    return value.substr(std::min(value.find_first_not_of(blanks), value.size()));
  }
  throw input_error(text.here(), "expected a line TILT=NONE, TILT=INCLUDE or TILT= and a file's name");
}

// TILT tells by what factor the lamp's output changes when the whole luminaire is tilted: one number at any
// tilt, that cancels when the diagram is normalised.
void skip_tilt(IesText &text) {
  if (skip_label(text) != "INCLUDE")
    return;
  text.count("lamp-to-luminaire geometry", {1.0, 3.0});
  const std::size_t pairs = text.count("number of tilt angles", angle_counts);
  for (std::size_t i = 0; i < pairs; ++i)
    text.number("tilt angle");
  for (std::size_t i = 0; i < pairs; ++i)
    text.number("tilt factor");
}

void expect_type_c(IesText &text) {
  const std::size_t type = text.count("photometric type", {1.0, 3.0});
  if (type != 1)
    throw input_error(text.here(), fmt::format("photometric type: expected 1 (type C), found {}, type {}",
                                               type, type == 2 ? 'B' : 'A'));
}

// Returns how many vertical and how many horizontal angles there are.
std::pair<std::size_t, std::size_t> read_head(IesText &text) {
  text.number("number of lamps");
  text.number("lumens per lamp");
  if (!(text.number("candela multiplier") > 0.0))
    throw input_error(text.here(), "candela multiplier: expected a number above 0");
  const std::size_t vertical =
      text.count("number of vertical angles", {2.0, static_cast<double>(max_diagram_values)});
  const std::size_t horizontal = text.count("number of horizontal angles", angle_counts);
  if (vertical * horizontal > max_diagram_values)
    throw input_error(text.here(),
                      fmt::format("expected at most {} candela values, found {} vertical times {} "
                                  "horizontal angles",
                                  max_diagram_values, vertical, horizontal));
  expect_type_c(text);
  for (const char *what : {"units", "width", "length", "height", "ballast factor",
                           "ballast-lamp factor or file generation type", "input watts"})
    text.number(what);
  return {vertical, horizontal};
}

std::vector<double> read_angles(IesText &text, std::size_t count, NumberRange range_deg, const char *what) {
  std::vector<double> angles_deg;
  while (angles_deg.size() < count) {
    const double angle_deg = text.number(what, range_deg);
    append_ascending(angles_deg, angle_deg, what, text.here());
  }
  return angles_deg;
}

// The symmetry that the first and the last horizontal angle tell: the values at an angle h are those of every
// phi = offset_deg + sign h, which are minus that angle and its mirror images.
struct Symmetry {
  struct Phi {
    double offset_deg, sign;
  };
  double first_deg, last_deg;
  std::vector<Phi> phis;
};

const Symmetry &symmetry_of(const std::vector<double> &horizontal_deg, const TextPlace &place) {
  static const std::vector<Symmetry> symmetries{
      {0.0, 90.0, {{0.0, 1.0}, {180.0, -1.0}, {180.0, 1.0}, {360.0, -1.0}}}, // of the quadrants
      {0.0, 180.0, {{0.0, 1.0}, {360.0, -1.0}}},                             // about 0 - 180
      {90.0, 270.0, {{360.0, -1.0}, {180.0, 1.0}}},                          // about 90 - 270
      {0.0, 360.0, {{360.0, -1.0}}},                                         // none
      {0.0, 0.0, {{360.0, -1.0}}},                                           // a single angle: no question
  };
  const double first = horizontal_deg.front(), last = horizontal_deg.back();
  for (const Symmetry &symmetry : symmetries)
    if (first == symmetry.first_deg && last == symmetry.last_deg)
      return symmetry;
  throw input_error(place,
                    fmt::format("horizontal angles: expected a single 0, or 0 to 90, 180 or 360, or 90 "
                                "to 270, found {} to {}",
                                first, last));
}

DiagramTable unfolded(const DiagramTable &table, const Symmetry &symmetry) {
  std::map<double, std::size_t> horizontal_at;
  for (std::size_t i = 0; i < table.phi_deg.size(); ++i)
    for (const auto [offset_deg, sign] : symmetry.phis) {
      const double phi_deg = offset_deg + sign * table.phi_deg[i];
      horizontal_at.emplace(phi_deg >= 360.0 ? phi_deg - 360.0 : phi_deg, i);
    }
  DiagramTable whole{table.file, table.theta_deg, {}, {}};
  for (const auto &[phi_deg, i] : horizontal_at)
    whole.phi_deg.push_back(phi_deg);
  whole.values.reserve(table.theta_deg.size() * horizontal_at.size());
  for (std::size_t theta = 0; theta < table.theta_deg.size(); ++theta)
    for (const auto &[phi_deg, i] : horizontal_at)
      whole.values.push_back(table.at(theta, i));
  return whole;
}

} // namespace

DiagramTable read_ies(const std::filesystem::path &file, std::string_view bytes) {
  IesText text(file, bytes);
  skip_tilt(text);
  const auto [vertical, horizontal] = read_head(text);
  DiagramTable table{file, {}, {}, {}}; // phi is the horizontal angle, until it is unfolded
  table.theta_deg = read_angles(text, vertical, {0.0, 180.0}, "vertical angle");
  table.phi_deg = read_angles(text, horizontal, {0.0, 360.0}, "horizontal angle");
  const Symmetry &symmetry = symmetry_of(table.phi_deg, text.here());
  table.values.resize(vertical * horizontal);
  for (std::size_t phi = 0; phi < horizontal; ++phi)
    for (std::size_t theta = 0; theta < vertical; ++theta) {
      const double candela = text.number("candela value", {0.0, max_diagram_value});
      table.at(theta, phi) = {candela, text.here().line};
    }
  text.expect_end();
  close_turn(table);
  return unfolded(table, symmetry);
}

} // namespace pmdsim
