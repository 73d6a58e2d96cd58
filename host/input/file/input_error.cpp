#include "host/input/file/input_error.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// File names come from the user too and may hold line breaks.
std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char byte) { return byte < 0x20 || byte == 0x7f; }, '?');
  return text;
}

// "FILE: POINTER", "FILE" for the empty pointer.
std::string text_of(const Place &place) {
  return place.pointer.empty() ? place.file.string()
                               : fmt::format("{}: {}", place.file.string(), place.pointer.to_string());
}

} // namespace

Place operator/(const Place &place, const std::string &key) {
  return {place.file, place.pointer / key, place.folder};
}

Place operator/(const Place &place, std::size_t index) {
  return {place.file, place.pointer / index, place.folder};
}

Error input_error(const Place &place, std::string_view message) {
  return {ExitCode::input,
          one_line(fmt::format("{}: {}", text_of(place), message)),
          {place.file.string(), place.pointer.to_string()}};
}

Error input_error(const TextPlace &place, std::string_view message) {
  if (place.line == 0)
    return input_error(Place{place.file}, message);
  const std::string column = place.column == 0 ? "" : fmt::format(":{}", place.column);
  const std::string position = fmt::format("{}{}", place.line, column);
  return {ExitCode::input,
          one_line(fmt::format("{}:{}: {}", place.file.string(), position, message)),
          {place.file.string(), position}};
}

Error input_error(const AnyPlace &place, std::string_view message) {
  return std::visit([&](const auto &known) { return input_error(known, message); }, place);
}

Warning input_warning(const char *code, const Place &place, std::string text) {
  return {code, one_line(text_of(place)), one_line(std::move(text))};
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 80;
  const bool cut = text.size() > longest;
  const nlohmann::json shown = std::string(text.substr(0, longest)) + (cut ? "..." : "");
  return shown.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

} // namespace pmdsim
