// Changes of inputs that are JSON, by its values and not by its bytes: most changes of bytes end in the
// parser and never reach the reader behind it. libFuzzer calls this in place of its own changes.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

using nlohmann::ordered_json;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size, std::size_t max_size,
                                               unsigned seed);

namespace {

using Random = std::minstd_rand;

std::size_t below(Random &random, std::size_t count) { return random() / 7 % count; }

void list_values(ordered_json &json, std::vector<ordered_json *> &values) {
  values.push_back(&json);
  if (json.is_structured())
    for (ordered_json &value : json)
      list_values(value, values);
}

std::vector<ordered_json *> values_of(ordered_json &json) {
  std::vector<ordered_json *> values;
  list_values(json, values);
  return values;
}

ordered_json number_beside(const ordered_json &json, Random &random) {
  static const std::vector<ordered_json> numbers{0,
                                                 1,
                                                 -1,
                                                 2,
                                                 3,
                                                 255,
                                                 256,
                                                 65535,
                                                 65536,
                                                 2147483647,
                                                 2147483648,
                                                 4294967295,
                                                 4294967296,
                                                 9007199254740993,
                                                 std::numeric_limits<std::int64_t>::min(),
                                                 std::numeric_limits<std::uint64_t>::max(),
                                                 0.5,
                                                 -0.5,
                                                 -0.0,
                                                 1e-320,
                                                 1e-30,
                                                 1e-7,
                                                 1e7,
                                                 1e30,
                                                 3.5e38,
                                                 1e308};
  const double number = json.get<double>();
  switch (below(random, 6)) {
  case 0:
    return number + 1.0;
  case 1:
    return -number;
  case 2:
    return number * 2.0;
  case 3:
    return json.is_number_integer() ? ordered_json(json.get<std::int64_t>() ^ 1) : ordered_json(number / 3.0);
  default:
    return numbers[below(random, numbers.size())];
  }
}

std::string text_beside(const std::string &text) {
  std::string changed = text + std::string(8, '\0');
  changed.resize(
      LLVMFuzzerMutate(reinterpret_cast<std::uint8_t *>(changed.data()), text.size(), changed.size()));
  return changed;
}

void change_structure(ordered_json &json, const ordered_json &other, Random &random) {
  if (json.empty())
    return;
  const auto at = std::next(json.begin(), static_cast<std::ptrdiff_t>(below(random, json.size())));
  switch (below(random, 3)) {
  case 0:
    json.erase(at);
    break;
  case 1:
    *at = other;
    break;
  default:
    if (json.is_array() && json.size() < 1000)
      json.push_back(ordered_json(*at));
    else if (json.is_object() && other.is_object() && !other.empty()) { // a key of another place
      const auto from = std::next(other.begin(), static_cast<std::ptrdiff_t>(below(random, other.size())));
      json[from.key()] = ordered_json(from.value());
    }
  }
}

void change_value(ordered_json &root, Random &random) {
  static const std::vector<ordered_json> plain{
      nullptr, true, false, 0, "", ordered_json::array(), ordered_json::object()};
  const std::vector<ordered_json *> values = values_of(root);
  ordered_json &json = *values[below(random, values.size())];
  const ordered_json other = *values[below(random, values.size())]; // a copy, as it may hold the first
  if (below(random, 12) == 0)
    json = plain[below(random, plain.size())];
  else if (below(random, 8) == 0)
    json = other;
  else if (json.is_number())
    json = number_beside(json, random);
  else if (json.is_string())
    json = text_beside(json.get<std::string>());
  else if (json.is_structured())
    change_structure(json, other, random);
}

// Nothing where the text is no JSON.
std::optional<std::string> changed_json(std::string_view text, Random &random) {
  ordered_json json = ordered_json::parse(text, nullptr, false, true);
  if (json.is_discarded())
    return std::nullopt;
  for (std::size_t i = 1 + below(random, 3); i > 0; --i)
    change_value(json, random);
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

constexpr std::string_view glb_magic("glTF\2\0\0\0", 8), between_parts = "\n----\n";

void append_32(std::string &bytes, std::size_t value) {
  for (const unsigned shift : {0u, 8u, 16u, 24u})
    bytes.push_back(static_cast<char>(value >> shift));
}

// The JSON of a binary glTF, whose lengths fit again then.
std::optional<std::string> changed_glb(std::string_view bytes, Random &random) {
  constexpr std::size_t before_json = 20;
  std::uint32_t json_bytes = 0;
  if (bytes.size() < before_json)
    return std::nullopt;
  std::memcpy(&json_bytes, bytes.data() + 12, sizeof(json_bytes));
  if (json_bytes > bytes.size() - before_json)
    return std::nullopt;
  std::optional<std::string> json = changed_json(bytes.substr(before_json, json_bytes), random);
  if (!json)
    return std::nullopt;
  json->resize((json->size() + 3) / 4 * 4, ' ');
  const std::string_view rest = bytes.substr(before_json + json_bytes);
  std::string changed(glb_magic);
  append_32(changed, before_json + json->size() + rest.size());
  append_32(changed, json->size());
  return changed + "JSON" + *json + std::string(rest);
}

// One of the parts that `separator` parts, in place.
std::optional<std::string> changed_part(std::string_view text, std::string_view separator, Random &random) {
  std::vector<std::size_t> begins{0};
  for (std::size_t at = 0; (at = text.find(separator, at)) != text.npos; begins.push_back(at))
    at += separator.size();
  const std::size_t begin = begins[below(random, begins.size())];
  const std::size_t end = std::min(text.find(separator, begin), text.size());
  const std::optional<std::string> part = changed_json(text.substr(begin, end - begin), random);
  if (!part)
    return std::nullopt;
  return std::string(text.substr(0, begin)) + *part + std::string(text.substr(end));
}

std::optional<std::string> changed(std::string_view text, Random &random) {
  if (text.starts_with(glb_magic))
    return changed_glb(text, random);
  if (const auto whole = changed_json(text, random))
    return whole;
  return changed_part(text, text.find(between_parts) != text.npos ? between_parts : "\n", random);
}

} // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size, std::size_t max_size,
                                    unsigned seed) {
  Random random(seed + 1u);
  if (below(random, 5) > 0)
    if (const auto text = changed({reinterpret_cast<const char *>(data), size}, random);
        text && text->size() <= max_size) {
      std::memcpy(data, text->data(), text->size());
      return text->size();
    }
  return LLVMFuzzerMutate(data, size, max_size);
}
