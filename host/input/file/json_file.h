#pragma once
// JSON text from untrusted files: depth-limited, without doubled keys, errors in one line.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

namespace pmdsim {

enum class Comments { refused, allowed };

inline constexpr std::size_t max_json_depth = 64; // objects and arrays within each other

// A number without a fractional part is an integer in the result, even if it is written as 8.0 or 2e7.
// `file` is named in errors only. Throws Error (input): "FILE:LINE:COLUMN: ..." for a syntax error, a number
// beyond double or bytes that are not UTF-8; "FILE: POINTER: ..." for a doubled key or a document that is
// nested too deep.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path &file, Comments comments);

} // namespace pmdsim
