#include "host/input/array/array_formats.h"

#include "host/input/file/memory_request.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

// NaN for nothing.
double number_in(std::string_view field, const TextPlace &place) {
  if (field.empty())
    return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const std::string_view digits = field.substr(field.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size())
    return value;
  const bool has_comma = error == std::errc() && end != digits.data() + digits.size() && *end == ',';
  throw input_error(place,
                    fmt::format("expected a number{}, found {}",
                                has_comma ? " with a decimal point, not a comma" : "", in_quotes(field)));
}

// The fields of a line, separated by `;`, by `,`, or by blanks where the line has neither, and the columns of
// the file that they begin in.
struct Field {
  std::string_view text;
  std::size_t column;
};
std::vector<Field> fields_of(std::string_view line) {
  const char separator = line.find(';') != std::string_view::npos   ? ';'
                         : line.find(',') != std::string_view::npos ? ','
                                                                    : ' ';
  std::vector<Field> fields;
  for (std::string_view rest = line;;) {
    const std::size_t end =
        std::min(separator == ' ' ? rest.find_first_of(blanks) : rest.find(separator), rest.size());
    fields.push_back({trimmed(rest.substr(0, end)), line.size() - rest.size() + 1});
    if (end == rest.size())
      return fields;
    rest.remove_prefix(end + 1);
    if (separator == ' ')
      rest.remove_prefix(rest.find_first_not_of(blanks));
  }
}

// A line may be as long as the file.
void require_room_for_fields(std::string_view line, const Place &place) {
  constexpr std::size_t short_line = std::size_t{1} << 20;
  if (line.size() < short_line)
    return;
  const auto separators = std::ranges::count_if(
      line, [](char c) { return c == ';' || c == ',' || blanks.find(c) != std::string_view::npos; });
  require_memory(2 * sizeof(Field) * (static_cast<std::size_t>(separators) + 1), place, "a line of it");
}

// A header line: names of columns, of which none is a number.
bool are_names(const std::vector<Field> &fields) {
  return std::ranges::all_of(fields, [](const Field &field) {
    const std::string_view name = field.text.substr(field.text.starts_with('"') ? 1 : 0);
    const bool is_word =
        !name.empty() && (std::isalpha(static_cast<unsigned char>(name.front())) != 0 || name.front() == '_');
    double value = 0.0;
    return is_word && std::from_chars(name.data(), name.data() + name.size(), value).ec != std::errc();
  });
}

} // namespace

ImageArray text_array(std::string_view text, const Place &place) {
  ImageArray array{""};
  TextPlace at{place.file, 0};
  std::size_t columns = 0, rows = 0;
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++at.line;
    if (line.empty() || line.starts_with('#'))
      continue;
    require_room_for_fields(line, place);
    const std::vector<Field> fields = fields_of(line);
    if (std::exchange(is_first, false) && are_names(fields))
      continue;
    if (const std::size_t values = array.values.size() + fields.size(); values > array.values.capacity())
      require_memory(2 * values * sizeof(double), place, "its numbers");
    for (const Field &field : fields)
      array.values.push_back(number_in(field.text, {at.file, at.line, field.column}));
    if (rows++ == 0)
      columns = fields.size();
    else if (fields.size() != columns)
      throw input_error(
          at, fmt::format("expected {} numbers as in the rows before, found {}", columns, fields.size()));
  }
  if (rows == 0)
    throw input_error(place, "expected an image as NPY, NPZ, EXR, HDF5, PNG or rows of numbers, found no "
                             "number");
  array.resolution = {columns, rows};
  return array;
}

} // namespace pmdsim
