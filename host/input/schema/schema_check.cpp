#include "host/input/schema/schema_check.h"

#include "host/input/file/memory_request.h"
#include "host/input/schema/hints.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <locale>
#include <optional>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

// The keywords that our schemas use: $ref into definitions, anyOf, properties, items (one schema, or one for
// each item).

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

bool has_type(const json &value, const std::string &type) {
  if (type == "integer" || type == "number")
    return value.is_number();
  return type == value.type_name();
}

// Whether `value` has a key whose text is another than the constant that the schema states for it.
bool has_other_constant(const json &schema, const json &value) {
  const json properties = schema.value("properties", json::object());
  for (const auto &[key, property] : properties.items())
    if (property.contains("const") && property.at("const").is_string() && value.contains(key) &&
        value.at(key) != property.at("const"))
      return true;
  return false;
}

// Whether `value` is what `schema` is about: it has the type (an enum: that of one of its
// values) and, an object, all required keys and no other text than a constant one ("model": "fisheye").
bool is_about(const json &schema, const json &value) {
  if (schema.contains("const"))
    return value == schema.at("const");
  const json choices = schema.value("enum", json::array());
  if (!choices.empty() && std::none_of(choices.begin(), choices.end(),
                                       [&](const json &choice) { return choice.type() == value.type(); }))
    return false;
  if ((schema.contains("type") && !has_type(value, schema.at("type"))) || has_other_constant(schema, value))
    return false;
  const json required = schema.value("required", json::array());
  return std::all_of(required.begin(), required.end(),
                     [&](const json &key) { return value.contains(key.get_ref<const std::string &>()); });
}

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

// The value that a schema asks for, as a noun phrase: "an integer from 1 to 16". A schema's `title` is that
// phrase, if given.
std::string expectation(const json &root, const json &schema_or_reference);

// The phrase and the value of the keyword, where the schema has it.
std::string stated(const json &schema, const char *phrase, const char *keyword) {
  return schema.contains(keyword) ? phrase + schema.at(keyword).dump() : "";
}

std::string number_expectation(const json &schema) {
  const std::string noun = schema.at("type") == "integer" ? "an integer" : "a number";
  if (schema.contains("minimum") && schema.contains("maximum"))
    return noun + stated(schema, " from ", "minimum") + stated(schema, " to ", "maximum");
  return noun + stated(schema, " of at least ", "minimum") + stated(schema, " above ", "exclusiveMinimum") +
         stated(schema, " and at most ", "maximum");
}

std::string array_expectation(const json &root, const json &schema) {
  const bool is_bounded = schema.contains("minItems") && schema.contains("maxItems");
  std::string size = stated(schema, is_bounded ? " of " : " of at least ", "minItems");
  if (is_bounded && schema.at("minItems") != schema.at("maxItems"))
    size += stated(schema, " to ", "maxItems");
  const bool alike = schema.contains("items") && schema.at("items").is_object();
  return "an array" + size + (alike ? ", each " + expectation(root, schema.at("items")) : "");
}

template <class Phrase>
std::string one_of(const json &values, Phrase phrase_of) {
  std::vector<std::string> phrases;
  for (const json &value : values)
    phrases.push_back(phrase_of(value));
  return fmt::format("{}", fmt::join(phrases, " or "));
}

std::string expectation(const json &root, const json &schema_or_reference) {
  const json &schema = resolved(root, schema_or_reference);
  if (schema.contains("title"))
    return schema.at("title");
  if (schema.contains("const"))
    return schema.at("const").dump();
  if (schema.contains("enum"))
    return one_of(schema.at("enum"), [](const json &value) { return value.dump(); });
  if (schema.contains("anyOf"))
    return one_of(schema.at("anyOf"), [&](const json &part) { return expectation(root, part); });
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

// A value beside the schema that describes it.
struct Spot {
  Place place;
  const json *schema; // after the choice between alternatives
  const json *value;
};

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

// The keys that may stand in what the schema describes.
std::vector<std::string> known_keys(const json &root, const json &schema) {
  std::vector<std::string> keys;
  const json properties = schema.value("properties", json::object());
  for (const auto &[key, property] : properties.items())
    keys.push_back(key);
  for (const json &alternative : schema.value("anyOf", json::array()))
    for (std::string &key : known_keys(root, resolved(root, alternative)))
      if (std::ranges::find(keys, key) == keys.end())
        keys.push_back(std::move(key));
  return keys;
}

// Texts that may stand where the schema describes a value.
std::vector<std::string> known_texts(const json &root, const json &schema) {
  std::vector<std::string> texts;
  const auto add = [&](const json &value) {
    if (value.is_string())
      texts.push_back(value);
  };
  if (schema.contains("const"))
    add(schema.at("const"));
  for (const json &value : schema.value("enum", json::array()))
    add(value);
  for (const json &alternative : schema.value("anyOf", json::array()))
    std::ranges::move(known_texts(root, resolved(root, alternative)), std::back_inserter(texts));
  return texts;
}

// Where in a document a key may stand, at `at` or below; of an array the first element. Nothing where it may
// not.
std::optional<json::json_pointer> holder_of(const std::string &key, const json &root, const json &schema,
                                            const json::json_pointer &at = json::json_pointer()) {
  const json &whole = resolved(root, schema);
  const json properties = whole.value("properties", json::object());
  if (properties.contains(key))
    return at;
  for (const auto &[name, property] : properties.items())
    if (const auto found = holder_of(key, root, property, at / name))
      return found;
  for (const json &alternative : whole.value("anyOf", json::array()))
    if (const auto found = holder_of(key, root, alternative, at))
      return found;
  const auto items = whole.find("items");
  return items != whole.end() && items->is_object() ? holder_of(key, root, *items, at / 0) : std::nullopt;
}

// Whether both are objects of one kind, "/sensors/0/pose" and "/illuminators/1/pose".
bool are_alike(const json::json_pointer &a, const json::json_pointer &b) {
  return !a.empty() && !b.empty() && a.back() == b.back();
}

Error unknown_key(const json &root, const Spot &spot, const std::string &key) {
  const std::vector<std::string> known = known_keys(root, *spot.schema);
  std::string hint = key_hint(key, known);
  if (const auto holder = hint.empty() ? holder_of(key, root, root) : std::nullopt;
      holder && !are_alike(*holder, spot.place.pointer))
    hint = "; it belongs to " + (holder->empty() ? "the outermost object" : holder->to_string());
  if (hint.empty() && !known.empty())
    hint = "; expected " + listed_names(known);
  return key_error(spot.place, key, fmt::format("unknown key {}{}", in_quotes(key), hint));
}

std::optional<Error> wrong_key(const json &root, const Spot &spot) {
  if (!spot.value->is_object())
    return std::nullopt;
  if (is_closed(root, *spot.schema))
    for (const auto &[key, value] : spot.value->items())
      if (!knows(root, *spot.schema, key))
        return unknown_key(root, spot, key);
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

// The way towards a failure, as far as the alternatives lead that the document has chosen. `context` is
// valijson's: "<root>", then a "[key]" or "[index]" for each step.
std::vector<Spot> way_to(const std::vector<std::string> &context, const json &document, const json &root,
                         const Place &whole) {
  std::vector<Spot> way{{whole, &chosen(root, root, document), &document}};
  for (std::size_t i = 1; i < context.size(); ++i) {
    const auto next = step(root, way.back(), context[i].substr(1, context[i].size() - 2));
    if (!next)
      break;
    way.push_back(*next);
  }
  return way;
}

// valijson tells the failures of all alternatives, and each again on the way out. The deepest in the chosen
// ones is the cause, the others follow from it.
Spot deepest_failure(const valijson::ValidationResults &failures, const json &document, const json &root,
                     const Place &whole) {
  std::vector<Spot> deepest = way_to({}, document, root, whole);
  for (const auto &failure : failures) {
    if (failure.context.size() <= deepest.size()) // cannot lead deeper; there may be a million of these
      continue;
    const std::vector<Spot> way = way_to(failure.context, document, root, whole);
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
  const std::string hint = spot.value->is_string() ? text_hint(spot.value->get_ref<const std::string &>(),
                                                               known_texts(root, *spot.schema))
                                                   : std::string();
  return input_error(spot.place, fmt::format("expected {}, found {}{}", expectation(root, *spot.schema),
                                             shown(*spot.value),
                                             hint.empty() ? value_hint(*spot.schema, *spot.value) : hint));
}

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
  const auto others = schema.find("additionalProperties");
  if (others != schema.end() && others->is_object())
    for (const auto &[key, each] : value.items())
      if (!schema.at("properties").contains(key))
        result[key] = filled(root, *others, each);
  return result;
}

// The C++ library keeps a table of characters in their narrow form, which std::regex fills as patterns are
// checked, in all threads at once and without a lock (GCC bug 77704). One that is filled beforehand is only
// read.
void fill_narrow_characters() {
  const auto &characters = std::use_facet<std::ctype<char>>(std::locale());
  for (int character = 0; character < 256; ++character)
    characters.narrow(static_cast<char>(character), '\0');
}

std::size_t values_in(const json &value) {
  std::size_t values = 1;
  if (value.is_structured())
    for (const json &each : value)
      values += values_in(each);
  return values;
}

} // namespace

DocumentSchema::DocumentSchema(json schema, std::size_t failure_bytes)
    : json_(std::move(schema)), failure_bytes_(failure_bytes), parsed_(std::make_unique<valijson::Schema>()) {
  fill_narrow_characters();
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(json_), *parsed_);
}

DocumentSchema::~DocumentSchema() = default;

void DocumentSchema::check(const json &document, const Place &root) const {
  const valijson::adapters::NlohmannJsonAdapter checked(document);
  if (valijson::Validator().validate(*parsed_, checked, nullptr)) // which ends with the first failure
    return;
  require_memory(values_in(document) * failure_bytes_, root, "looking for what is wrong");
  valijson::ValidationResults failures; // all, with their ways
  valijson::Validator().validate(*parsed_, checked, &failures);
  throw explained(deepest_failure(failures, document, json_, root), json_);
}

std::string expected_value(const json &schema, const json &part) { return expectation(schema, part); }

ordered_json with_defaults(const json &document, const ordered_json &schema) {
  return filled(schema, schema, document);
}

} // namespace pmdsim
