#include "host/output/run/run_json.h"

#include "host/input/file/json_file.h"

namespace pmdsim {
namespace {

// Whether brackets outside strings are nested deeper than JSON may be, or there are more values, of whatever
// text.
bool is_too_large(const std::string &text) {
  std::size_t depth = 0, values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char character = text[i];
    const bool opens = character == '{' || character == '[', closes = character == '}' || character == ']';
    if (character == '"') {
      in_string = !in_string;
    } else if (in_string) {
      i += character == '\\' ? 1 : 0;
    } else {
      depth += opens ? 1 : 0;
      depth -= closes && depth > 0 ? 1 : 0;
      values += opens || character == ',' ? 1 : 0;
    }
    if (depth > max_json_depth || values > max_json_values)
      return true;
  }
  return false;
}

} // namespace

std::optional<nlohmann::ordered_json> parsed_in_order(const std::string &text) {
  if (is_too_large(text))
    return std::nullopt;
  auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  return json.is_discarded() ? std::nullopt : std::optional(std::move(json));
}

} // namespace pmdsim
