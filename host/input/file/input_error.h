#pragma once
// How an error in an input file reads: one line with the file, the place in it and what was expected there.

#include "engine/model/error.h"
#include "engine/model/warning.h"
#include "host/input/words/quotes.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

namespace pmdsim {

// What a JSON document was read from, so that errors tell lines.
struct JsonSource {
  std::shared_ptr<const std::string> text{}; // null: none
  // Values that are not the text's, by JSON pointer, and who put them there: "--set". Empty: nobody with a
  // name.
  std::map<std::string, std::string> changes{};
};

// A value in a JSON document: the file and the JSON pointer (RFC 6901) in it; the empty pointer is the whole
// document.
struct Place {
  std::filesystem::path file;
  nlohmann::json::json_pointer pointer = nlohmann::json::json_pointer();
  std::filesystem::path folder = file.parent_path(); // where relative paths in it start
  std::shared_ptr<const JsonSource> source{};        // null: errors tell no line
};

Place operator/(const Place &place, const std::string &key);
Place operator/(const Place &place, std::size_t index);

// "FILE:LINE:COLUMN: POINTER: MESSAGE", where it is known in which line the value is, "FILE: POINTER
// (CHANGER): MESSAGE" where it was put there; no pointer where it is the empty one.
Error input_error(const Place &place, std::string_view message);
// As above, where it is the key that is wrong, in the object at `place`.
Error key_error(const Place &place, const std::string &key, std::string_view message);

// A place in a text file; lines and columns (characters) count from 1, column 0 stands for the whole line,
// and line 0 for the whole file.
struct TextPlace {
  std::filesystem::path file;
  std::size_t line = 1;
  std::size_t column = 0;
};

// Of the byte at `offset` of the file's text.
TextPlace text_place(const std::filesystem::path &file, std::string_view text, std::size_t offset);

// "FILE:LINE:COLUMN: MESSAGE", "FILE:LINE: MESSAGE" for a whole line.
Error input_error(const TextPlace &place, std::string_view message);

// A place that names a file: JSON and text files do.
using AnyPlace = std::variant<Place, TextPlace>;
Error input_error(const AnyPlace &place, std::string_view message);

// A warning about a place in an input file: "FILE: POINTER", "FILE" for the empty pointer.
Warning input_warning(const char *code, const Place &place, const std::string &text);

} // namespace pmdsim
