#pragma once
// The JSON Schemas (draft-07) that ship with the program, as text; generated from *.schema.json at configure
// time.

#include <string_view>

namespace pmdsim {

extern const std::string_view setup_schema_text; // a setup file
extern const std::string_view gltf_schema_text;  // the parts of glTF 2.0 that are read

} // namespace pmdsim
