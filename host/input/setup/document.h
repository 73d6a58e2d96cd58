#pragma once
// A setup as its JSON says it, and changes to it, before anything is made of it.

#include "host/input/file/input_error.h"
#include "host/input/gltf/document.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace pmdsim {

struct SetupDocument {
  std::filesystem::path file;                        // names it in errors
  nlohmann::json json{};                             // unchecked, without presets and defaults
  std::filesystem::path folder = file.parent_path(); // where relative paths in it start
  std::shared_ptr<const JsonSource> source{};        // null: errors tell no line
  UriFiles scene_files = UriFiles::beside;           // those that its scene names

  Place root() const { return {.file = file, .folder = folder, .source = source}; }
};

// Throws Error (input).
SetupDocument read_setup_document(const std::filesystem::path &file);
SetupDocument parse_setup_document(std::string_view text, const std::filesystem::path &file);

// Whether the document puts nodes of its scene somewhere, or sensors and illuminators at nodes.
bool names_nodes(const SetupDocument &document);

// A name as a part of a JSON pointer.
std::string escaped(std::string name);

// Puts the values of an object into the document: its keys are JSON pointers, with or without the first
// slash, where an element of an array may be given by its "name". What lies on the way is made where it is
// absent, but for elements of arrays. A null takes the key out, so that its default holds. `by` is who
// changes it, for errors, as "--set". Throws Error (input), and changes nothing then.
void change(SetupDocument &document, const nlohmann::json &values, const std::string &by = "");

} // namespace pmdsim
