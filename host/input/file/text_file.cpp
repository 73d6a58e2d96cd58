#include "host/input/file/text_file.h"

#include "host/input/file/regular_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <system_error>

namespace pmdsim {

namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 26;

// Readers would take a NUL for the end of a field.
void refuse_nul(std::string_view text, const std::filesystem::path &file) {
  const std::size_t nul = text.find('\0');
  if (nul == text.npos)
    return;
  const std::string_view before = text.substr(0, nul);
  const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  throw input_error(TextPlace{file, line}, "expected text, found a NUL byte");
}

} // namespace

std::string read_text_file(const std::filesystem::path &file, const AnyPlace &named_at) {
  std::string text = read_regular_file(file, max_file_bytes, named_at);
  refuse_nul(text, file);
  return text;
}

double number_of(std::string_view text, std::string_view what, const TextPlace &place) {
  double value = 0.0;
  const bool has_plus = text.starts_with('+') && !text.starts_with("+-"); // from_chars takes none
  const char *begin = text.data() + (has_plus ? 1 : 0);
  const char *end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value))
    throw input_error(place, fmt::format("{}: expected a number, found {}", what, in_quotes(text)));
  return value;
}

double number_in(Range range, std::string_view text, std::string_view what, const TextPlace &place) {
  const double value = number_of(text, what, place);
  if (value < range.lowest || value > range.highest)
    throw input_error(place, fmt::format("{}: expected a number from {} to {}, found {}", what, range.lowest,
                                         range.highest, in_quotes(text)));
  return value;
}

} // namespace pmdsim
