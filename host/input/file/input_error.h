#pragma once
// How an error in an input file reads: one line with the file, the place in it and what was expected there.

#include "engine/model/error.h"
#include "engine/model/warning.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

namespace pmdsim {

// A value in a JSON document: the file and the JSON pointer (RFC 6901) in it; the empty pointer is the whole
// document.
struct Place {
  std::filesystem::path file;
  nlohmann::json::json_pointer pointer = nlohmann::json::json_pointer();
  std::filesystem::path folder = file.parent_path(); // where relative paths in it start
};

Place operator/(const Place &place, const std::string &key);
Place operator/(const Place &place, std::size_t index);

// "FILE: POINTER: MESSAGE", "FILE: MESSAGE" for the empty pointer.
Error input_error(const Place &place, std::string_view message);
// A place in a text file; lines and columns (bytes) count from 1, column 0 stands for the whole line, and
// line 0 for the whole file.
struct TextPlace {
  std::filesystem::path file;
  std::size_t line = 1;
  std::size_t column = 0;
};

// "FILE:LINE:COLUMN: MESSAGE", "FILE:LINE: MESSAGE" for a whole line.
Error input_error(const TextPlace &place, std::string_view message);

// A place that names a file: JSON and text files do.
using AnyPlace = std::variant<Place, TextPlace>;
Error input_error(const AnyPlace &place, std::string_view message);

// A warning about a place in an input file: "FILE: POINTER", "FILE" for the empty pointer.
Warning input_warning(const char *code, const Place &place, std::string text);

// Text from an input file as it may stand in a message: in double quotes, escaped, of bounded length.
std::string in_quotes(std::string_view text);

} // namespace pmdsim
