#include "host/input/schema/schema_walk.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace pmdsim {

using nlohmann::json;

namespace {

bool has_type(const json &value, const std::string &type) {
  if (type == "integer" || type == "number")
    return value.is_number();
  return type == value.type_name();
}

std::string number_expectation(const json &schema) {
  std::string noun = schema.at("type") == "integer" ? "an integer" : "a number";
  if (schema.contains("minimum") && schema.contains("maximum"))
    return fmt::format("{} from {} to {}", noun, schema.at("minimum").dump(), schema.at("maximum").dump());
  if (schema.contains("exclusiveMinimum") && schema.contains("maximum"))
    return fmt::format("{} above {} and at most {}", noun, schema.at("exclusiveMinimum").dump(),
                       schema.at("maximum").dump());
  if (schema.contains("minimum"))
    return fmt::format("{} of at least {}", noun, schema.at("minimum").dump());
  if (schema.contains("exclusiveMinimum"))
    return fmt::format("{} above {}", noun, schema.at("exclusiveMinimum").dump());
  return noun;
}

std::string array_expectation(const json &root, const json &schema) {
  std::string size;
  if (schema.contains("minItems") && schema.contains("maxItems"))
    size = schema.at("minItems") == schema.at("maxItems")
               ? fmt::format(" of {}", schema.at("minItems").dump())
               : fmt::format(" of {} to {}", schema.at("minItems").dump(), schema.at("maxItems").dump());
  else if (schema.contains("minItems"))
    size = fmt::format(" of at least {}", schema.at("minItems").dump());
  const bool alike = schema.contains("items") && schema.at("items").is_object();
  return "an array" + size + (alike ? ", each " + expectation(root, schema.at("items")) : "");
}

std::string one_of(const json &root, const json &alternatives) {
  std::vector<std::string> phrases;
  for (const json &alternative : alternatives)
    phrases.push_back(expectation(root, alternative));
  return fmt::format("{}", fmt::join(phrases, " or "));
}

std::string listed(const json &values) {
  std::vector<std::string> texts;
  for (const json &value : values)
    texts.push_back(value.dump());
  return fmt::format("{}", fmt::join(texts, " or "));
}

// Whether `value` has a key whose text is another than the constant that the schema states for it.
bool has_other_constant(const json &schema, const json &value) {
  const json properties = schema.value("properties", json::object());
  const auto items = properties.items();
  return value.is_object() && std::any_of(items.begin(), items.end(), [&](const auto &property) {
           return property.value().contains("const") && property.value().at("const").is_string() &&
                  value.contains(property.key()) && value.at(property.key()) != property.value().at("const");
         });
}

} // namespace

bool is_about(const json &schema, const json &value) {
  if (schema.contains("const"))
    return value == schema.at("const");
  const json choices = schema.value("enum", json::array());
  if (!choices.empty() && std::none_of(choices.begin(), choices.end(),
                                       [&](const json &choice) { return choice.type() == value.type(); }))
    return false;
  if (schema.contains("type") && !has_type(value, schema.at("type")))
    return false;
  if (has_other_constant(schema, value))
    return false;
  const json required = schema.value("required", json::array());
  return std::all_of(required.begin(), required.end(),
                     [&](const json &key) { return value.contains(key.get_ref<const std::string &>()); });
}

std::string expectation(const json &root, const json &schema_or_reference) {
  const json &schema = resolved(root, schema_or_reference);
  if (schema.contains("title"))
    return schema.at("title");
  if (schema.contains("const"))
    return schema.at("const").dump();
  if (schema.contains("enum"))
    return listed(schema.at("enum"));
  if (schema.contains("anyOf"))
    return one_of(root, schema.at("anyOf"));
  const std::string type = schema.value("type", "value");
  if (type == "integer" || type == "number")
    return number_expectation(schema);
  if (type == "array")
    return array_expectation(root, schema);
  if (type == "boolean")
    return "true or false";
  if (type == "null")
    return "null";
  return type == "object" ? "an object" : "a " + type;
}

} // namespace pmdsim
