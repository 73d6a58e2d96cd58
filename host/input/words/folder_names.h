#pragma once
// What is in a folder.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace pmdsim {

// The names there, in no order, `most` at most; those that were read before `error`, where there is one.
// Unlike std::filesystem::directory_iterator, whose steps are noexcept in libstdc++ and allocate, it throws
// where memory is short.
std::vector<std::string> names_in(const std::filesystem::path &folder, std::error_code &error,
                                  std::size_t most = std::numeric_limits<std::size_t>::max());

// Whether a name that comes from a file can be one in a folder and in a message: not hidden, and in one line
// of UTF-8.
bool is_plain_name(std::string_view name);

} // namespace pmdsim
