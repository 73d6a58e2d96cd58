#include "host/input/schema/schema_check.h"

#include "host/input/file/input_error.h"
#include "host/input/schema/schema_walk.h"

#include <fmt/format.h>
#include <optional>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

namespace pmdsim {

using nlohmann::json;

namespace {

using Tokens = std::vector<std::string>; // keys and array indices from the document's root

// A value beside the schema that describes it.
struct Spot {
  Place place;
  const json *schema; // after the choice between alternatives
  const json *value;
};

Tokens tokens_of(const valijson::ValidationResults::Error &failure) {
  Tokens tokens(failure.context.begin() + 1, failure.context.end()); // behind "<root>"
  for (std::string &token : tokens)
    token = token.substr(1, token.size() - 2); // "[key]"
  return tokens;
}

std::optional<Spot> step(const json &root, const Spot &from, const std::string &token) {
  if (from.value->is_array() && from.schema->contains("items")) {
    const std::size_t index = std::stoul(token);
    const json &value = from.value->at(index);
    return Spot{from.place / index, &chosen(root, item_schema(*from.schema, index), value), &value};
  }
  if (!from.value->is_object() || !from.value->contains(token) || !from.schema->contains("properties"))
    return std::nullopt;
  const json &value = from.value->at(token);
  const json &properties = from.schema->at("properties");
  if (properties.contains(token))
    return Spot{from.place / token, &chosen(root, properties.at(token), value), &value};
  const auto others = from.schema->find("additionalProperties");
  if (others == from.schema->end() || !others->is_object())
    return std::nullopt;
  return Spot{from.place / token, &chosen(root, *others, value), &value};
}

bool knows(const json &root, const json &schema, const std::string &key) {
  for (const json &alternative : schema.value("anyOf", json::array()))
    if (knows(root, resolved(root, alternative), key))
      return true;
  return schema.contains("properties") && schema.at("properties").contains(key);
}

bool is_closed(const json &root, const json &schema) {
  for (const json &alternative : schema.value("anyOf", json::array()))
    if (is_closed(root, resolved(root, alternative)))
      return true;
  return schema.value("additionalProperties", json(true)) == false;
}

std::optional<Error> wrong_key(const json &root, const Spot &spot) {
  if (!spot.value->is_object())
    return std::nullopt;
  if (is_closed(root, *spot.schema))
    for (const auto &[key, value] : spot.value->items())
      if (!knows(root, *spot.schema, key))
        return input_error(spot.place, fmt::format("unknown key {}", in_quotes(key)));
  for (const json &key : spot.schema->value("required", json::array()))
    if (!spot.value->contains(key.get_ref<const std::string &>()))
      return input_error(spot.place, fmt::format("missing key {}", key.dump()));
  return std::nullopt;
}

std::string shown(const json &value) {
  if (value.is_object())
    return "an object";
  if (value.is_array())
    return fmt::format("an array of {}", value.size());
  return value.is_string() ? in_quotes(value.get_ref<const std::string &>()) : value.dump();
}

// As far towards a failure as the alternatives lead that the document has chosen.
std::vector<Spot> way_to(const Tokens &tokens, const json &document, const json &root,
                         const std::filesystem::path &file) {
  std::vector<Spot> way{{Place{file}, &chosen(root, root, document), &document}};
  for (const std::string &token : tokens) {
    const std::optional<Spot> next = step(root, way.back(), token);
    if (!next)
      break;
    way.push_back(*next);
  }
  return way;
}

// valijson tells the failures of all alternatives, and each again on the way out. The deepest in the chosen
// ones is the cause, the others follow from it.
Spot deepest_failure(const valijson::ValidationResults &failures, const json &document, const json &root,
                     const std::filesystem::path &file) {
  std::vector<Spot> deepest = way_to({}, document, root, file);
  for (const auto &failure : failures) {
    if (failure.context.size() <= deepest.size()) // cannot lead deeper; there may be a million of these
      continue;
    const std::vector<Spot> way = way_to(tokens_of(failure), document, root, file);
    const bool is_of_another =
        way.back().schema->contains("const") && way.back().schema->at("const") == *way.back().value;
    if (way.size() > deepest.size() && !is_of_another)
      deepest = way;
  }
  return deepest.back();
}

Error explained(const Spot &spot, const json &root) {
  if (auto error = wrong_key(root, spot))
    return *error;
  return input_error(
      spot.place, fmt::format("expected {}, found {}", expectation(root, *spot.schema), shown(*spot.value)));
}

} // namespace

void check_schema(const json &document, const json &schema_document, const std::filesystem::path &file) {
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_document), schema);
  valijson::ValidationResults failures;
  if (!valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &failures))
    throw explained(deepest_failure(failures, document, schema_document, file), schema_document);
}

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
