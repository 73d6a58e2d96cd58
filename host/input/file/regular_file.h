#pragma once
// Reads files that others name: never a directory, a FIFO or a device, and never more than a stated size.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace pmdsim {

// The bytes of a regular file. Never waits on what is no regular file. Throws Error (input) at `named_at`,
// the place that names the file (its own Place where the user named it on the command line).
std::string read_regular_file(const std::filesystem::path &file, std::size_t max_bytes,
                              const AnyPlace &named_at);

// The first `length_bytes` of a regular file, and nothing beyond them. As above; throws for a shorter file
// too.
std::string read_front_of_regular_file(const std::filesystem::path &file, std::size_t length_bytes,
                                       const Place &named_at);

} // namespace pmdsim
