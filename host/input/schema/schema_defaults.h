#pragma once
// The defaults of a JSON Schema, written into a document.

#include <nlohmann/json.hpp>

namespace pmdsim {

// A valid document with every absent key that has a `default` filled in, keys in the schema's order.
nlohmann::ordered_json with_defaults(const nlohmann::json &document, const nlohmann::ordered_json &schema);

} // namespace pmdsim
