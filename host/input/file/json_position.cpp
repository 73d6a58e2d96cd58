#include "host/input/file/json_position.h"

#include "host/input/file/json_tokens.h"

#include <string>
#include <vector>

namespace pmdsim {
namespace {

using Kind = JsonToken::Kind;

bool opens(const JsonToken &token) {
  return token.kind == Kind::open_object || token.kind == Kind::open_array;
}
bool closes(const JsonToken &token) {
  return token.kind == Kind::close_object || token.kind == Kind::close_array;
}

class Way {
public:
  explicit Way(std::string_view text) : text_(text), tokens_(text) {}

  // Goes into the container that `opening` begins, up to its member `part`. Leaves the member's first token
  // as the last one read.
  std::optional<JsonPosition> enter(const JsonToken &opening, const std::string &part, int occurrence) {
    const bool is_object = opening.kind == Kind::open_object;
    std::size_t index = 0;
    for (value_ = tokens_.next(); !closes(value_) && value_.kind != Kind::end;) {
      const JsonToken first = value_;
      if (is_object) {
        tokens_.next(); // the colon
        value_ = tokens_.next();
      }
      const bool is_it = is_object ? json_text_of(text_, first) == part : std::to_string(index) == part;
      if (is_it && --occurrence == 0)
        return JsonPosition{first.begin, value_.begin};
      skip_value();
      ++index;
    }
    return std::nullopt;
  }

  JsonToken first() { return value_ = tokens_.next(); }
  const JsonToken &value() const { return value_; }

private:
  // From the value's first token to the next member's, or to what closes its container.
  void skip_value() {
    std::size_t depth = 0;
    for (;; value_ = tokens_.next()) {
      if (opens(value_))
        ++depth;
      else if (closes(value_) && depth > 0)
        --depth;
      if (depth == 0 || value_.kind == Kind::end)
        break;
    }
    value_ = tokens_.next();
    if (value_.kind == Kind::comma)
      value_ = tokens_.next();
  }

  std::string_view text_;
  JsonTokens tokens_;
  JsonToken value_{};
};

} // namespace

std::optional<JsonPosition> position_in_json(std::string_view text,
                                             const nlohmann::json::json_pointer &pointer, int occurrence) {
  std::vector<std::string> parts;
  for (auto rest = pointer; !rest.empty(); rest.pop_back())
    parts.insert(parts.begin(), rest.back());
  Way way(text);
  const std::size_t begin = way.first().begin;
  std::optional<JsonPosition> position = JsonPosition{begin, begin};
  for (std::size_t i = 0; i < parts.size() && position; ++i)
    position = opens(way.value()) ? way.enter(way.value(), parts[i], i + 1 == parts.size() ? occurrence : 1)
                                  : std::nullopt;
  return position;
}

} // namespace pmdsim
