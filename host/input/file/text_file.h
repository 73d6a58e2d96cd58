#pragma once
// Text files that hold numbers.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace pmdsim {

// Both ends belong to it.
struct Range {
  double lowest, highest;
};

// The bytes of a regular file of at most 2^26 bytes, none of them NUL. Throws Error (input): at `named_at`,
// the place that names the file, where it cannot be read; "FILE:LINE: ..." for a NUL.
std::string read_text_file(const std::filesystem::path &file, const AnyPlace &named_at);

// The number that `text` is, all of it; finite, with or without a sign. Throws Error (input) at `place`;
// `what` says what the number is.
double number_of(std::string_view text, std::string_view what, const TextPlace &place);
double number_in(Range range, std::string_view text, std::string_view what, const TextPlace &place);

} // namespace pmdsim
