// The schema of setups is what an editor completes and explains keys by.

#include "host/input/schema/schema_check.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

using nlohmann::json;

namespace {

// Calls `visit` with the JSON pointer and the schema of every key, however deep.
template <class Visit>
void for_each_key(const json &schema, const std::string &pointer, const Visit &visit) {
  if (schema.is_array()) {
    for (std::size_t i = 0; i < schema.size(); ++i)
      for_each_key(schema[i], pointer + "/" + std::to_string(i), visit);
    return;
  }
  for (const char *keyword : {"items", "anyOf"})
    if (schema.contains(keyword))
      for_each_key(schema.at(keyword), pointer + "/" + keyword, visit);
  const json properties = schema.value("properties", json::object());
  for (const auto &[key, property] : properties.items()) {
    visit(pointer + "/" + key, property);
    for_each_key(property, pointer + "/" + key, visit);
  }
}

} // namespace

TEST_CASE("Every key of a setup is described") {
  const json schema = json::parse(pmdsim::setup_schema_text);
  std::size_t keys = 0;
  for_each_key(schema, "", [&](const std::string &pointer, const json &property) {
    INFO(pointer);
    CHECK(property.value("description", "").size() > 8);
    ++keys;
  });
  CHECK(keys > 60);
}

TEST_CASE("A key with a default says so") {
  const json schema = json::parse(pmdsim::setup_schema_text);
  for_each_key(schema, "", [&](const std::string &pointer, const json &property) {
    INFO(pointer);
    const auto description = property.value("description", "");
    if (property.contains("default"))
      CHECK((description.find("default") != std::string::npos ||
             description.find("Default") != std::string::npos));
  });
}

TEST_CASE("Every number of a setup that is supported has a range") {
  const json schema = json::parse(pmdsim::setup_schema_text);
  const auto check = [](const std::string &pointer, const json &number) {
    INFO(pointer);
    CHECK((number.contains("minimum") || number.contains("exclusiveMinimum")));
    CHECK(number.contains("maximum"));
  };
  for_each_key(schema, "", [&](const std::string &pointer, const json &property) {
    if (pointer.ends_with("/up"))
      return; // a direction of any length
    const auto is_number = [](const json &part) { return part.value("type", "") == "number"; };
    if (is_number(property))
      check(pointer, property);
    else if (property.contains("items") && property.at("items").is_object() &&
             is_number(property.at("items")))
      check(pointer + "/items", property.at("items"));
  });
}
