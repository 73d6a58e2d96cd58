#include "host/input/setup/document.h"

#include "host/input/file/input_error.h"
#include "host/input/file/input_file.h"
#include "host/input/file/json_file.h"
#include "host/input/words/file_kind.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr std::size_t max_setup_bytes = std::size_t{1} << 22;

// Where a setup or a command takes such a file, as the end of a message.
std::string place_in_setup(std::string_view kind) {
  if (kind.find("glTF") != kind.npos)
    return ", which names it as its \"scene\"";
  if (kind.find("IES") != kind.npos)
    return ", which names it in an illuminator's \"pattern\"";
  if (kind.find("picture") != kind.npos || kind.find("NumPy") != kind.npos || kind.find("HDF5") != kind.npos)
    return "; an image to correct comes behind it, as in pmdsim correct setup.json IMAGE";
  return "";
}

// Of a table in place of a setup: what it is, and where a setup names it. Nothing where it is none.
std::optional<std::string> table_in_setup(std::string_view bytes, const std::string &name) {
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  if (line.find_first_of("{[\"") != line.npos || line.find_first_of(",;\t") == line.npos)
    return std::nullopt;
  const auto has = [&](std::string_view column) { return line.find(column) != line.npos; };
  const auto named = [&](const char *what, const char *key) {
    return fmt::format("is {}, expected a setup (JSON), which names it: {} = {{\"file\": {}}}", what, key,
                       in_quotes(name));
  };
  if (has("axis_x") || has("x_m,") || has("intensity_w_sr"))
    return named("a table of diodes", "\"illuminators\"[0].\"diodes\"");
  if (has("angle_deg") || has("theta_deg"))
    return named("a table of a radiation diagram", "\"illuminators\"[0].\"pattern\"");
  return name.ends_with(".csv") ? std::optional("is a table (CSV), expected a setup (JSON)") : std::nullopt;
}

// In place of what its bytes mean as JSON.
void refuse_other_kinds(std::string_view bytes, const Place &whole_file) {
  const std::string kind = kind_of_file(whole_file.file, bytes);
  if (!kind.empty())
    throw input_error(whole_file,
                      fmt::format("is {}, expected a setup (JSON){}", kind, place_in_setup(kind)));
  if (const auto table = table_in_setup(bytes, whole_file.file.filename().string()))
    throw input_error(whole_file, *table);
  if (bytes.empty())
    throw input_error(whole_file, "is empty, expected a setup (JSON)");
}

// The parts of a JSON pointer (RFC 6901). Nothing where it is none.
std::optional<std::vector<std::string>> parts_of(const std::string &path) {
  if (static_cast<std::size_t>(std::ranges::count(path, '/')) > max_json_depth)
    return std::nullopt;
  try {
    const json::json_pointer whole(path.starts_with('/') ? path : "/" + path);
    std::vector<std::string> parts;
    for (json::json_pointer rest = whole; !rest.empty(); rest.pop_back())
      parts.insert(parts.begin(), rest.back());
    return parts;
  } catch (const json::exception &) {
    return std::nullopt;
  }
}

// The element that `part` names, by its index or its "name".
std::optional<std::size_t> index_in(const json &array, const std::string &part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc() && end == part.data() + part.size())
    return index < array.size() ? std::optional(index) : std::nullopt;
  const auto named = std::ranges::find_if(array, [&](const json &element) {
    return element.is_object() && element.contains("name") && element.at("name") == part;
  });
  return named == array.end() ? std::nullopt : std::optional(static_cast<std::size_t>(named - array.begin()));
}

// The names of an array's elements.
std::vector<std::string> names_in(const json &array) {
  std::vector<std::string> names;
  for (const json &element : array)
    if (element.is_object() && element.contains("name") && element.at("name").is_string())
      names.push_back(element.at("name"));
  return names;
}

// `what` begins the message where there is none.
std::size_t index_of(const json &array, const std::string &part, const Place &place,
                     const std::string &what) {
  const auto index = index_in(array, part);
  if (!index)
    throw input_error(place, fmt::format("{}: expected the index or the name of one of {}, found {}{}", what,
                                         array.size(), in_quotes(part), did_you_mean(part, names_in(array))));
  return *index;
}

std::vector<std::string> parts_of_change(const std::string &path, const Place &place,
                                         const std::string &what) {
  const auto parts = parts_of(path);
  if (!parts || path.empty())
    throw input_error(place, what + ": expected a path such as sensors/0/focal_length_m");
  return *parts;
}

enum class Absent { made, left };

// Where the value of the last of `parts` is, and `place` then; what is absent on the way is made, or the way
// ends there, at nothing. `what` begins messages, with the path.
json *value_at(json &document, Place &place, const std::vector<std::string> &parts, const std::string &what,
               Absent absent) {
  json *at = &document;
  for (const std::string &part : parts) {
    if (absent == Absent::left && (at->is_null() || (at->is_object() && !at->contains(part))))
      return nullptr;
    if (at->is_null())
      *at = json::object();
    if (at->is_object()) {
      at = &(*at)[part];
      place = place / part;
    } else if (at->is_array()) {
      const std::size_t index = index_of(*at, part, place, what);
      at = &at->at(index);
      place = place / index;
    } else {
      throw input_error(place, fmt::format("{}: expected an object or an array here, found {}", what,
                                           in_quotes(at->dump())));
    }
  }
  return at;
}

// Returns the value's JSON pointer.
std::string put(json &document, Place place, const std::string &path, const json &value,
                const std::string &what) {
  *value_at(document, place, parts_of_change(path, place, what), what, Absent::made) = value;
  return place.pointer.to_string();
}

void refuse_near_key(const json &object, const std::string &key, const Place &place,
                     const std::string &what) {
  std::vector<std::string> keys;
  for (const auto &[known, value] : object.items())
    keys.push_back(known);
  if (const std::string meant = did_you_mean(key, keys); !meant.empty())
    throw input_error(place, fmt::format("{}: there is no key {} to remove{}", what, in_quotes(key), meant));
}

// Takes a key out of its object. One that is not there need not be, but one that is written nearly as another
// is a mistake. Elements of arrays stay, as null.
void remove(json &document, Place place, const std::string &path, const std::string &what) {
  std::vector<std::string> parts = parts_of_change(path, place, what);
  const std::string key = parts.back();
  parts.pop_back();
  json *holder = value_at(document, place, parts, what, Absent::left);
  if (!holder || holder->is_null())
    return;
  if (!holder->is_object())
    *value_at(*holder, place, {key}, what, Absent::left) = nullptr;
  else if (holder->erase(key) == 0)
    refuse_near_key(*holder, key, place, what);
}

} // namespace

SetupDocument read_setup_document(const std::filesystem::path &file) {
  auto text = std::make_shared<const std::string>(read_regular_file(file, max_setup_bytes, Place{file}));
  refuse_other_kinds(*text, Place{file});
  SetupDocument document = parse_setup_document(*text, file);
  if (document.json.is_object() && document.json.contains("asset") && document.json.contains("nodes"))
    throw input_error(Place{file}, "is a glTF scene, expected a setup, which names it as its \"scene\"");
  document.source = std::make_shared<const JsonSource>(JsonSource{std::move(text)});
  return document;
}

SetupDocument parse_setup_document(std::string_view text, const std::filesystem::path &file) {
  return {file, parse_json(text, file, Comments::allowed)};
}

namespace {

bool has_node(const nlohmann::json &part) {
  return (part.is_object() && part.contains("node")) ||
         (part.is_structured() && std::ranges::any_of(part, has_node));
}

} // namespace

bool names_nodes(const SetupDocument &document) {
  const nlohmann::json &setup = document.json;
  if (!setup.is_object())
    return false;
  const auto part = [&](const char *key) { return setup.value(key, nlohmann::json::array()); };
  return !part("nodes").empty() || has_node(part("sensors")) || has_node(part("illuminators"));
}

std::string escaped(std::string name) {
  for (std::size_t at = 0; (at = name.find_first_of("~/", at)) != std::string::npos; at += 2)
    name.replace(at, 1, name[at] == '~' ? "~0" : "~1");
  return name;
}

void change(SetupDocument &document, const json &values, const std::string &by) {
  if (!values.is_object())
    throw input_error(Place{document.file}, "cannot set anything: expected an object of paths and values");
  json changed = document.json;
  auto source = std::make_shared<JsonSource>(document.source ? *document.source : JsonSource{});
  for (const auto &[path, value] : values.items()) {
    const std::string what = fmt::format("{}cannot set {}", by.empty() ? "" : by + " ", in_quotes(path));
    if (value.is_null())
      remove(changed, document.root(), path, what);
    else
      source->changes[put(changed, document.root(), path, value, what)] = by;
  }
  document.json = std::move(changed);
  document.source = std::move(source);
}

} // namespace pmdsim
