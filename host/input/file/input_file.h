#pragma once
// Reads files that others name: never a directory, a FIFO or a device, and never more than a stated size. And
// the numbers that text files hold.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace pmdsim {

// The bytes of a regular file. Never waits on what is no regular file. Throws Error (input) at `named_at`,
// the place that names the file (its own Place where the user named it on the command line).
std::string read_regular_file(const std::filesystem::path &file, std::size_t max_bytes,
                              const AnyPlace &named_at);

// The first `length_bytes` of a regular file, and nothing beyond them. As above; throws for a shorter file
// too.
std::string read_front_of_regular_file(const std::filesystem::path &file, std::size_t length_bytes,
                                       const Place &named_at);

// The bytes of a regular file of at most 2^26 bytes, none of them NUL. As above; throws "FILE:LINE: ..." for
// a NUL.
std::string read_text_file(const std::filesystem::path &file, const AnyPlace &named_at);

// Both ends belong to it.
struct NumberRange {
  double lowest = std::numeric_limits<double>::lowest(), highest = std::numeric_limits<double>::max();
};

// The number that `text` is, all of it; finite, with or without a sign. Throws Error (input) at `place`;
// `what` says what the number is.
double number_of(std::string_view text, std::string_view what, const TextPlace &place,
                 NumberRange range = {});

} // namespace pmdsim
