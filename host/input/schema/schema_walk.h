#pragma once
// Steps through a JSON Schema (draft-07) beside a document that it describes. Knows the keywords that our
// schemas use: $ref into definitions, anyOf, properties, items (one schema, or one for each item).

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim {

// The schema itself, behind any "$ref": "#/definitions/...".
template <class Json>
const Json &resolved(const Json &root, const Json &schema) {
  const auto reference = schema.find("$ref");
  if (reference == schema.end())
    return schema;
  const auto text = reference->template get<std::string>();
  return root.at(typename Json::json_pointer(text.substr(1)));
}

// The schema of an array's item; `array_schema` has items, and one for this index.
template <class Json>
const Json &item_schema(const Json &array_schema, std::size_t index) {
  const Json &items = array_schema.at("items");
  return items.is_array() ? items.at(index) : items;
}

// Whether `value` is what `schema` is about: it has the type (an enum: that of one of its
// values) and, an object, all required keys and no other text than a constant one ("model": "fisheye").
bool is_about(const nlohmann::json &schema, const nlohmann::json &value);

// The alternative of an anyOf that `value` is meant as; the schema itself where there is none or no anyOf.
template <class Json>
const Json &chosen(const Json &root, const Json &schema, const nlohmann::json &value) {
  const Json &whole = resolved(root, schema);
  if (!whole.contains("anyOf"))
    return whole;
  for (const Json &alternative : whole.at("anyOf"))
    if (is_about(resolved(root, alternative), value))
      return resolved(root, alternative);
  return whole;
}

// What a schema asks for, as a noun phrase: "an integer from 1 to 16". A schema's `title` is that phrase, if
// given.
std::string expectation(const nlohmann::json &root, const nlohmann::json &schema);

} // namespace pmdsim
