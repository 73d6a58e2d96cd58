#include "host/input/schema/schema_defaults.h"

#include "host/input/schema/schema_walk.h"

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

ordered_json filled(const ordered_json &root, const ordered_json &schema_or_anyof, const json &value) {
  const ordered_json &schema = chosen(root, schema_or_anyof, value);
  if (value.is_array() && schema.contains("items")) {
    ordered_json result = ordered_json::array();
    for (std::size_t i = 0; i < value.size(); ++i)
      result.push_back(filled(root, item_schema(schema, i), value[i]));
    return result;
  }
  if (!value.is_object() || !schema.contains("properties"))
    return value;
  ordered_json result = ordered_json::object();
  for (const auto &[key, property] : schema.at("properties").items()) {
    if (value.contains(key))
      result[key] = filled(root, property, value.at(key));
    else if (property.contains("default"))
      result[key] = filled(root, property, property.at("default"));
  }
  return result;
}

} // namespace

ordered_json with_defaults(const json &document, const ordered_json &schema) {
  return filled(schema, schema, document);
}

} // namespace pmdsim
