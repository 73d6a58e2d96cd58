#include "host/input/diagram/csv_text.h"

#include "host/input/schema/hints.h"
#include "host/input/words/quotes.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <system_error>

namespace pmdsim {
namespace {

constexpr std::string_view csv_blanks = " \t\r";

bool is_number(std::string_view field) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

} // namespace

std::string_view line_of_text(std::string_view text, std::size_t number) {
  constexpr std::string_view mark = "\xef\xbb\xbf"; // of byte order
  if (text.starts_with(mark))
    text.remove_prefix(mark.size());
  for (; number > 1; --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

std::vector<std::string_view> csv_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, end);
    field.remove_prefix(std::min(field.find_first_not_of(csv_blanks), field.size()));
    fields.push_back(field.substr(0, field.find_last_not_of(csv_blanks) + 1));
    if (end == line.size())
      return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<std::string> header_problem(std::string_view line) {
  if (line.find(',') == line.npos && line.find(';') != line.npos)
    return "expected commas between the columns, found semicolons";
  if (line.find(',') == line.npos && line.find('\t') != line.npos)
    return "expected commas between the columns, found tabs";
  if (std::ranges::all_of(csv_fields(line), is_number))
    return "expected a header line, the names of the columns, found numbers";
  return std::nullopt;
}

std::string unknown_columns_text(const std::vector<std::string_view> &header,
                                 const std::vector<std::string> &known, std::size_t required) {
  std::vector<std::string> unknown;
  for (const std::string_view column : header)
    if (std::ranges::find(known, column) == known.end())
      unknown.push_back(in_quotes(column) + key_hint(column, known));
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(std::min(required, known.size()));
  return fmt::format("unknown column{} {}; the columns are {}{}{}", unknown.size() == 1 ? "" : "s",
                     fmt::join(unknown, "; "), fmt::join(known.begin(), middle, ","),
                     middle == known.end()     ? ""
                     : middle == known.begin() ? "some of "
                                               : " and perhaps ",
                     fmt::join(middle, known.end(), ","));
}

std::string missing_columns_text(const std::vector<std::string> &missing) {
  return fmt::format("missing column{} {}", missing.size() == 1 ? "" : "s", fmt::join(missing, ", "));
}

std::string row_problem(std::string_view line, std::size_t expected) {
  if (line.find(',') == line.npos && line.find(';') != line.npos)
    return "found semicolons between them";
  const std::size_t found = csv_fields(line).size();
  return fmt::format("found {}{}", found, found > expected ? " (decimals have a point, not a comma)" : "");
}

} // namespace pmdsim
