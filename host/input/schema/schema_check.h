#pragma once
// Documents beside JSON Schemas: checks that say in one line what is wrong, where, and what was expected, and
// defaults.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace valijson {
class Schema;
}

namespace pmdsim {

// The JSON Schemas (draft-07) that ship with the program; generated from *.schema.json at configure time.
extern const std::string_view setup_schema_text; // a setup file
extern const std::string_view gltf_schema_text;  // the parts of glTF 2.0 that are read

// A schema that is parsed once, however many documents are checked.
class DocumentSchema {
public:
  // `failure_bytes` is about what looking for the fault takes in memory for each value of a document.
  DocumentSchema(nlohmann::json schema, std::size_t failure_bytes);
  ~DocumentSchema();
  // A wrong key or value is thrown as Error (input) with its place in the document, which is at `root`.
  void check(const nlohmann::json &document, const Place &root) const;

private:
  nlohmann::json json_;
  std::size_t failure_bytes_;
  std::unique_ptr<valijson::Schema> parsed_;
};

// The value that a part of a schema asks for, as errors say it: "an integer from 1 to 16".
std::string expected_value(const nlohmann::json &schema, const nlohmann::json &part);

// A valid document with every absent key that has a `default` filled in, keys in the schema's order.
nlohmann::ordered_json with_defaults(const nlohmann::json &document, const nlohmann::ordered_json &schema);

} // namespace pmdsim
