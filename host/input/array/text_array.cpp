#include "host/input/array/array_formats.h"

#include <charconv>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

double number_in(std::string_view field, const TextPlace &place) {
  double value = 0.0;
  const std::string_view digits = field.substr(field.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw input_error(place, fmt::format("expected a number, found {}", in_quotes(field)));
  return value;
}

// Takes the numbers of a line, separated by `,`, by `;`, or by blanks where the line has neither.
std::size_t take_line(std::string_view line, TextPlace place, std::vector<double> &values) {
  const char separator = line.find(',') != std::string_view::npos   ? ','
                         : line.find(';') != std::string_view::npos ? ';'
                                                                    : ' ';
  const std::size_t before = values.size(), length = line.size();
  for (std::string_view rest = line;;) {
    const std::size_t end =
        std::min(separator == ' ' ? rest.find_first_of(blanks) : rest.find(separator), rest.size());
    place.column = length - rest.size() + 1;
    values.push_back(number_in(trimmed(rest.substr(0, end)), place));
    if (end == rest.size())
      return values.size() - before;
    rest.remove_prefix(end + 1);
    if (separator == ' ')
      rest.remove_prefix(rest.find_first_not_of(blanks));
  }
}

} // namespace

ImageArray text_array(std::string_view text, const Place &place) {
  ImageArray array{""};
  TextPlace at{place.file, 0};
  std::size_t columns = 0, rows = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++at.line;
    if (line.empty() || line.starts_with('#'))
      continue;
    const std::size_t found = take_line(line, at, array.values);
    if (rows++ == 0)
      columns = found;
    else if (found != columns)
      throw input_error(at,
                        fmt::format("expected {} numbers as in the rows before, found {}", columns, found));
  }
  if (rows == 0)
    throw input_error(place, "expected an image as NPY, NPZ, EXR, HDF5, PNG or rows of numbers, found no "
                             "number");
  array.resolution = {columns, rows};
  return array;
}

} // namespace pmdsim
