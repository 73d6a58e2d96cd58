#include "host/output/run/run_json.h"

#include "host/input/file/memory_request.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::size_t value_bytes = 64;       // about, in a list or an object
constexpr std::size_t many_values = 1u << 14; // fewer are taken without a question

// How many values there are, of whatever text; nothing where brackets outside strings are nested deeper than
// JSON may be, or there are more.
std::optional<std::size_t> values_of(const std::string &text, std::size_t max_values) {
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
    if (depth > max_json_depth || values > max_values)
      return std::nullopt;
  }
  return values;
}

} // namespace

std::optional<nlohmann::ordered_json>
parsed_in_order(const std::string &text, const std::filesystem::path &file, std::size_t max_values) {
  const std::optional<std::size_t> values = values_of(text, max_values);
  if (!values)
    return std::nullopt;
  if (*values > many_values)
    require_memory(*values * value_bytes, Place{file}, fmt::format("a document of {} values", *values));
  auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  return json.is_discarded() ? std::nullopt : std::optional(std::move(json));
}

} // namespace pmdsim
