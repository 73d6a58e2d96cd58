#include "engine/model/channel_names.h"

#include <charconv>

namespace pmdsim {
namespace {

// The number that `text` is, in no more digits than it needs.
std::optional<std::size_t> index_of(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || (text.size() > 1 && text.front() == '0'))
    return std::nullopt;
  return value;
}

const ChannelRow *row_named(std::string_view name) {
  const auto row = std::ranges::find(channel_rows, name, &ChannelRow::name);
  return row == channel_rows.end() ? nullptr : &*row;
}

// Before the unit, metres or millimetres.
constexpr std::string_view rest_mark = "_rest";

} // namespace

std::string rest_name(std::string_view name) {
  std::string of_rest(name);
  return of_rest.insert(std::min(name.rfind("_m"), name.size()), rest_mark);
}

std::optional<std::string> name_of_rest(std::string_view name) {
  const std::size_t mark = name.rfind(rest_mark);
  if (mark == name.npos)
    return std::nullopt;
  std::string rounded(name);
  rounded.erase(mark, rest_mark.size());
  return rest_name(rounded) == name ? std::optional(rounded) : std::nullopt;
}

ChannelName channel_named(std::string_view name) {
  ChannelName found{nullptr, std::nullopt, std::nullopt};
  if (const std::size_t dot = name.find('.'); name.starts_with('f') && dot != name.npos) {
    found.frequency = index_of(name.substr(1, dot - 1));
    if (!found.frequency)
      return found;
    name.remove_prefix(dot + 1);
  }
  const ChannelRow *row = row_named(name);
  if (!row) {
    const std::size_t digits = name.find_last_not_of("0123456789") + 1;
    row = row_named(name.substr(0, digits));
    found.tap = index_of(name.substr(digits));
    if (!row || !is_of_taps(*row) || !found.tap)
      return {nullptr, std::nullopt, std::nullopt};
  }
  if (found.frequency && !is_of_frequency(*row))
    return {nullptr, std::nullopt, std::nullopt};
  found.row = row;
  return found;
}

} // namespace pmdsim
