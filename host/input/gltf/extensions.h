#pragma once
// The glTF extensions that a file may require, a row each, and their parts in a document. A new one that
// carries data takes a row, its part's form in gltf.schema.json, and the code that reads it by
// extension_part().

#include "host/input/file/input_error.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// An index into another array of the document.
struct ExtensionReference {
  std::string_view holder; // of a part: a path from the document on, "bufferViews/*"; * is every element
  std::string_view member; // of the part: a path, too
  std::string_view into;   // which array of the document
};

struct GltfExtension {
  enum class Use { read, without_effect };
  std::string_view name;
  Use use;
  std::vector<ExtensionReference> references{};
};

const std::vector<GltfExtension> &gltf_extensions();

// The part of the extension `name`, which is read, of an object that has passed the glTF schema; null where
// there is none.
const nlohmann::json *extension_part(const nlohmann::json &object, std::string_view name);

// What to export instead of an extension that is not read, as the end of a message; empty where nothing is
// known.
std::string remedy_for(std::string_view extension);

// Throws Error (input) at the first required extension without which the file would be another scene here.
void refuse_other_extensions(const nlohmann::json &document, const Place &root);

} // namespace pmdsim
