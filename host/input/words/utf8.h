#pragma once
// UTF-8 (RFC 3629), and text that may stand in a line for people.

#include <cstddef>
#include <string>
#include <string_view>

namespace pmdsim {

// How many bytes the character has that begins `text`; 0 where none does, also of an empty text.
std::size_t character_bytes(std::string_view text);

bool is_utf8(std::string_view text);

// The text in one line of UTF-8, whatever it was: ? for each control character (C0, DEL and C1) and for each
// byte that belongs to no character.
std::string in_one_line(std::string_view text);

} // namespace pmdsim
