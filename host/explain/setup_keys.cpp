#include "host/explain/setup_keys.h"

#include "host/input/schema/schema_check.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// The end of a name is its unit. Of several that fit the first one counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> units{
    {{"_w_m2_sr", "W/(m² sr)"},
     {"_w_sr", "W/sr"},
     {"_dn_per_e", "digital numbers per electron"},
     {"_e_per_s", "electrons per second"},
     {"_bits", "bits"},
     {"_deg", "degrees"},
     {"_hz", "hertz"},
     {"_dn", "digital numbers"},
     {"_e", "electrons"},
     {"_m", "metres"},
     {"_s", "seconds"}}};

std::string unit_of(std::string_view name) {
  const auto unit = std::ranges::find_if(units, [&](const auto &row) { return name.ends_with(row.first); });
  return unit == units.end() ? "" : std::string(unit->second);
}

class Walk {
public:
  std::vector<SetupKey> keys;

  explicit Walk(const ordered_json &root) : root_(root), checked_(nlohmann::json(root)) {
    object(root, "", "");
  }

private:
  const ordered_json &resolved(const ordered_json &schema) const {
    const auto reference = schema.find("$ref");
    return reference == schema.end()
               ? schema
               : root_.at(ordered_json::json_pointer(reference->get<std::string>().substr(1)));
  }

  // Adds the keys of an object's schema, and all below them.
  void object(const ordered_json &schema, const std::string &path, const std::string &beside) {
    const auto required = schema.value("required", std::vector<std::string>{});
    const ordered_json properties = schema.value("properties", ordered_json::object());
    for (const auto &[name, property] : properties.items()) {
      const bool is_stated =
          !beside.empty() && property.contains("const"); // the key that says which form it is
      if (!is_stated)
        key(name, property, path, beside, std::ranges::find(required, name) != required.end());
    }
    const auto others = schema.find("additionalProperties");
    if (others != schema.end() && others->is_object())
      inside(*others, path + "*/");
  }

  void key(const std::string &name, const ordered_json &schema, const std::string &path,
           const std::string &beside, bool required) {
    const ordered_json &whole = resolved(schema);
    SetupKey key{.path = path + name,
                 .beside = beside,
                 .about = schema.value("description", whole.value("description", "")),
                 .expected = expected_value(checked_, whole),
                 .unit = unit_of(name),
                 .required = required};
    if (whole.contains("default"))
      key.standard = whole.at("default");
    key.example = example_of(whole);
    const std::size_t index = keys.size();
    keys.push_back(std::move(key));
    inside(whole, path + name + "/");
    for (std::size_t i = index + 1; i < keys.size(); ++i)
      add_name_inside(keys[index], keys[i].path);
  }

  // What a schema's value may hold: the keys of an object, the objects of an array, in all forms that it has.
  void inside(const ordered_json &schema_or_reference, const std::string &path,
              const std::string &beside = "") {
    const ordered_json &schema = resolved(schema_or_reference);
    object(schema, path, beside);
    const auto items = schema.find("items");
    if (items != schema.end() && items->is_object())
      inside(*items, path + "*/");
    const ordered_json forms = schema.value("anyOf", ordered_json::array());
    for (const ordered_json &form : forms)
      inside(form, path, form_of(resolved(form)));
  }

  // `"model": "fisheye"` of a form that is told by such a key.
  static std::string form_of(const ordered_json &form) {
    const ordered_json properties = form.value("properties", ordered_json::object());
    for (const auto &[name, property] : properties.items())
      if (property.contains("const") && property.at("const").is_string())
        return ordered_json(name).dump() + ": " + property.at("const").dump();
    return "";
  }

  static nlohmann::json example_of(const ordered_json &schema) {
    if (schema.contains("examples"))
      return schema.at("examples").at(0);
    if (schema.contains("default"))
      return schema.at("default");
    if (schema.contains("const"))
      return schema.at("const");
    return schema.contains("enum") ? nlohmann::json(schema.at("enum").at(0)) : nlohmann::json();
  }

  static void add_name_inside(SetupKey &key, const std::string &path) {
    std::string name = path.substr(key.path.size() + 1);
    if (name.starts_with("*/"))
      name.erase(0, 2);
    if (name.find('/') == std::string::npos && std::ranges::find(key.inside, name) == key.inside.end())
      key.inside.push_back(name);
  }

  const ordered_json &root_;
  nlohmann::json checked_;
};

std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path)
    if (c == '/')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

bool is_number(const std::string &text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
}

// Whether the last parts of the path are the words'.
bool ends_like(const std::vector<std::string> &path, const std::vector<std::string> &words) {
  return words.size() <= path.size() && std::equal(words.rbegin(), words.rend(), path.rbegin(),
                                                   [](const std::string &word, const std::string &part) {
                                                     return part == "*" || word == part;
                                                   });
}

} // namespace

const std::vector<SetupKey> &setup_keys() {
  static const std::vector<SetupKey> keys = [] {
    const ordered_json schema = ordered_json::parse(setup_schema_text);
    return Walk(schema).keys;
  }();
  return keys;
}

std::vector<SetupKey> keys_meant(std::string_view words) {
  if (words.starts_with('/'))
    words.remove_prefix(1);
  std::vector<std::string> parts = parts_of(words);
  std::vector<SetupKey> meant;
  const auto find = [&] {
    std::ranges::copy_if(setup_keys(), std::back_inserter(meant),
                         [&](const SetupKey &key) { return ends_like(parts_of(key.path), parts); });
  };
  find();
  while (meant.empty() && parts.size() > 1 &&
         (is_number(parts.back()) || parts.back() == "*")) { // one of a list
    parts.pop_back();
    find();
  }
  return meant;
}

} // namespace pmdsim
