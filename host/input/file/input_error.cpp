#include "host/input/file/input_error.h"

#include "host/input/file/json_position.h"
#include "host/input/words/utf8.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace pmdsim {
namespace {

// File names and keys come from others too and may hold anything.
Error line_error(std::string_view message, const std::filesystem::path &file, std::string_view place) {
  return {ExitCode::input, in_one_line(message), {in_one_line(file.string()), in_one_line(place)}};
}

// "FILE: POINTER", "FILE" for the empty pointer.
std::string text_of(const Place &place) {
  return place.pointer.empty() ? place.file.string()
                               : fmt::format("{}: {}", place.file.string(), place.pointer.to_string());
}

using Pointer = nlohmann::json::json_pointer;

// Who changed the value, or one that it is part of; nothing where nobody did.
std::optional<std::string> changer(const JsonSource &source, Pointer pointer) {
  for (;; pointer.pop_back()) {
    if (const auto change = source.changes.find(pointer.to_string()); change != source.changes.end())
      return change->second;
    if (pointer.empty())
      return std::nullopt;
  }
}

// Who made a value that the text has not by changing a part of it.
std::string maker(const JsonSource &source, const Pointer &pointer) {
  const std::string parts = pointer.to_string() + "/";
  const auto first = source.changes.lower_bound(parts);
  return first != source.changes.end() && first->first.starts_with(parts) ? first->second : "";
}

// Of the value or, where it is no part of the text, of the nearest around it.
std::optional<std::size_t> offset_of(std::string_view text, Pointer pointer, bool of_key) {
  for (;; pointer.pop_back()) {
    if (const auto position = position_in_json(text, pointer))
      return of_key ? position->key : position->value;
    if (pointer.empty())
      return std::nullopt;
    of_key = false;
  }
}

struct Whence {
  std::string position{}, change{}; // as they stand behind the file and behind the pointer
};

Whence whence(const Place &place, const Pointer &pointer, bool of_key) {
  if (!place.source)
    return {};
  const auto by = changer(*place.source, pointer);
  if (by)
    return {"", by->empty() ? "" : fmt::format(" (by {})", *by)};
  if (!place.source->text)
    return {};
  const std::string &text = *place.source->text;
  if (!position_in_json(text, pointer))
    if (const std::string made_by = maker(*place.source, pointer); !made_by.empty())
      return {"", fmt::format(" (by {})", made_by)};
  const auto offset = offset_of(text, pointer, of_key);
  if (!offset)
    return {};
  const TextPlace at = text_place(place.file, text, *offset);
  return {fmt::format(":{}:{}", at.line, at.column), ""};
}

Error error_at(const Place &place, const Whence &whence, std::string_view message) {
  const std::string pointer = place.pointer.to_string();
  const std::string within = pointer + whence.change;
  const std::string line = fmt::format("{}{}: {}{}{}", place.file.string(), whence.position,
                                       within.substr(std::min(within.find_first_not_of(' '), within.size())),
                                       within.empty() ? "" : ": ", message);
  return line_error(line, place.file, pointer);
}

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80U; }

} // namespace

Place operator/(const Place &place, const std::string &key) {
  return {place.file, place.pointer / key, place.folder, place.source};
}

Place operator/(const Place &place, std::size_t index) {
  return {place.file, place.pointer / index, place.folder, place.source};
}

Error input_error(const Place &place, std::string_view message) {
  return error_at(place, whence(place, place.pointer, false), message);
}

Error key_error(const Place &place, const std::string &key, std::string_view message) {
  return error_at(place, whence(place, place.pointer / key, true), message);
}

TextPlace text_place(const std::filesystem::path &file, std::string_view text, std::size_t offset) {
  constexpr std::string_view mark = "\xef\xbb\xbf"; // of byte order, which editors do not count
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_start = before.rfind('\n') + 1; // npos + 1 is 0
  std::string_view line = before.substr(line_start);
  if (line_start == 0 && line.starts_with(mark))
    line.remove_prefix(mark.size());
  return {file, static_cast<std::size_t>(std::ranges::count(before, '\n')) + 1,
          line.size() - static_cast<std::size_t>(std::ranges::count_if(line, continues_character)) + 1};
}

Error input_error(const TextPlace &place, std::string_view message) {
  if (place.line == 0)
    return input_error(Place{place.file}, message);
  const std::string column = place.column == 0 ? "" : fmt::format(":{}", place.column);
  const std::string position = fmt::format("{}{}", place.line, column);
  return line_error(fmt::format("{}:{}: {}", place.file.string(), position, message), place.file, position);
}

Error input_error(const AnyPlace &place, std::string_view message) {
  return std::visit([&](const auto &known) { return input_error(known, message); }, place);
}

Warning input_warning(const char *code, const Place &place, const std::string &text) {
  return {code, in_one_line(text_of(place)), in_one_line(text)};
}

} // namespace pmdsim
