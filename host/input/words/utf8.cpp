#include "host/input/words/utf8.h"

#include <algorithm>
#include <optional>

namespace pmdsim {
namespace {

// How many bytes of the character that begins `text` are to follow the first, within which the second lies;
// nothing where no character begins so. Source: RFC 3629, section 4.
struct Utf8Start {
  std::size_t more;
  unsigned char least = 0x80, most = 0xbf;
};

std::optional<Utf8Start> utf8_start(unsigned char first) {
  if (first < 0x80)
    return Utf8Start{0};
  if (first >= 0xc2 && first <= 0xdf)
    return Utf8Start{1};
  if (first >= 0xe0 && first <= 0xef)
    return Utf8Start{2, static_cast<unsigned char>(first == 0xe0 ? 0xa0 : 0x80),
                     static_cast<unsigned char>(first == 0xed ? 0x9f : 0xbf)};
  if (first >= 0xf0 && first <= 0xf4)
    return Utf8Start{3, static_cast<unsigned char>(first == 0xf0 ? 0x90 : 0x80),
                     static_cast<unsigned char>(first == 0xf4 ? 0x8f : 0xbf)};
  return std::nullopt;
}

bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  return character.size() == 1 ? byte(0) < 0x20 || byte(0) == 0x7f
                               : character.size() == 2 && byte(0) == 0xc2 && byte(1) < 0xa0;
}

} // namespace

std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto start = text.empty() ? std::nullopt : utf8_start(byte(0));
  if (!start || start->more >= text.size() ||
      (start->more > 0 && (byte(1) < start->least || byte(1) > start->most)))
    return 0;
  for (std::size_t i = 2; i <= start->more; ++i)
    if (byte(i) < 0x80 || byte(i) > 0xbf)
      return 0;
  return start->more + 1;
}

bool is_utf8(std::string_view text) {
  while (const std::size_t length = character_bytes(text))
    text.remove_prefix(length);
  return text.empty();
}

std::string in_one_line(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_bytes(text);
    const std::string_view character = text.substr(0, length);
    line += length == 0 || is_control(character) ? "?" : character;
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return line;
}

} // namespace pmdsim
