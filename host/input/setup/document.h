#pragma once
// A setup as its JSON says it, and changes to it, before anything is made of it.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace pmdsim {

struct SetupDocument {
  std::filesystem::path file;                        // names it in errors
  nlohmann::json json{};                             // unchecked, without presets and defaults
  std::filesystem::path folder = file.parent_path(); // where relative paths in it start
};

// Throws Error (input).
SetupDocument read_setup_document(const std::filesystem::path &file);
SetupDocument parse_setup_document(std::string_view text, const std::filesystem::path &file);

// A name as a part of a JSON pointer.
std::string escaped(std::string name);

// Puts the values of an object into the document: its keys are JSON pointers, with or without the first
// slash, where an element of an array may be given by its "name". What lies on the way is made where it is
// absent, but for elements of arrays. Throws Error (input), and changes nothing then.
void change(SetupDocument &document, const nlohmann::json &values);

} // namespace pmdsim
