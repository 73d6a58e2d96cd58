#include "host/output/run/run_json.h"

#include "host/input/file/memory_request.h"

#include <fmt/format.h>
#include <vector>

namespace pmdsim {
namespace {

constexpr std::size_t value_bytes = 64;       // about, in a list or an object
constexpr std::size_t many_values = 1u << 14; // fewer are taken without a question
constexpr std::size_t max_run_keys = std::size_t{1}
                                     << 12; // of an object, whose keys are looked for one after the other

// Of whatever text, outside of its strings.
class ValueCount {
public:
  // False where there are too many, or they are nested deeper than JSON may be.
  bool add(char character, std::size_t max_values) {
    if (character == '{' || character == '[')
      open_.push_back({character == '{', 1});
    if ((character == '}' || character == ']') && !open_.empty())
      open_.pop_back();
    if (character == ',' && !open_.empty())
      ++open_.back().entries;
    values_ += character == '{' || character == '[' || character == ',' ? 1u : 0u;
    return open_.size() <= max_json_depth && values_ <= max_values &&
           (open_.empty() || !open_.back().is_object || open_.back().entries <= max_run_keys);
  }
  std::size_t values() const { return values_; }

private:
  struct Open {
    bool is_object;
    std::size_t entries;
  };
  std::vector<Open> open_;
  std::size_t values_ = 1;
};

// Nothing where there are more than a run has.
std::optional<std::size_t> values_of(const std::string &text, std::size_t max_values) {
  ValueCount count;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"')
      in_string = !in_string;
    else if (in_string)
      i += text[i] == '\\' ? 1u : 0u;
    else if (!count.add(text[i], max_values))
      return std::nullopt;
  }
  return count.values();
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
