#include "host/input/file/json_syntax.h"

#include "host/input/file/input_error.h"
#include "host/input/file/json_tokens.h"
#include "host/input/words/json_words.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <vector>

namespace pmdsim {
namespace {

using Kind = JsonToken::Kind;

// Follows the grammar of JSON as far as the text does.
class Reading {
public:
  Reading(std::string_view text, bool comments_allowed)
      : text_(text), tokens_(text), comments_allowed_(comments_allowed) {}

  std::optional<JsonProblem> problem() {
    while (!problem_ && !done_) {
      last_ = token_;
      token_ = tokens_.next();
      look_at_comments();
      if (!problem_)
        look_at_token();
    }
    return problem_;
  }

private:
  // What the grammar has next.
  enum class Next { value, value_or_close, key, key_or_close, colon, comma_or_close, end };
  struct Container {
    Kind opened_by;
    std::size_t begin;
  };

  void refuse(std::size_t at, std::string message) { problem_ = JsonProblem{at, std::move(message)}; }
  void expected(const std::string &what) {
    refuse(token_.begin, fmt::format("expected {}, found {}", what, found()));
  }

  std::string_view written(const JsonToken &token) const {
    return text_.substr(token.begin, token.end - token.begin);
  }
  std::string found() const {
    return token_.kind == Kind::end ? "the end of the file" : std::string(written(token_).substr(0, 40));
  }
  std::size_t line_of(std::size_t at) const {
    return static_cast<std::size_t>(std::ranges::count(text_.substr(0, at), '\n')) + 1;
  }
  bool is_word() const { return token_.kind == Kind::word; }

  void look_at_comments() {
    const std::string_view between = text_.substr(last_.end, token_.begin - last_.end);
    const std::size_t begin = between.find('/');
    if (begin == between.npos)
      return;
    if (!comments_allowed_)
      refuse(last_.end + begin, "expected no comments in this file, found one");
    else if (token_.kind == Kind::end && between.rfind("/*") != between.npos && !between.ends_with("*/"))
      refuse(last_.end + between.rfind("/*"), "expected */ at the end of the comment, found none");
  }

  void look_at_token() {
    if (is_word())
      if (const auto foreign = foreign_word(written(token_)))
        return refuse(token_.begin, *foreign);
    switch (next_) {
    case Next::value:
    case Next::value_or_close:
      return take_value();
    case Next::key:
    case Next::key_or_close:
      return take_key();
    case Next::colon:
      return take_colon();
    case Next::comma_or_close:
      return take_comma();
    case Next::end:
      if (token_.kind != Kind::end)
        expected("the end of the file after the last bracket");
      done_ = true;
    }
  }

  void take_value() {
    switch (token_.kind) {
    case Kind::text:
      check_text();
      return after_value();
    case Kind::word:
      if (!is_json_word(written(token_)))
        refuse(token_.begin, wrong_value(written(token_)));
      return after_value();
    case Kind::open_object:
    case Kind::open_array:
      open_.push_back({token_.kind, token_.begin});
      next_ = token_.kind == Kind::open_object ? Next::key_or_close : Next::value_or_close;
      return;
    case Kind::close_array:
      return next_ == Next::value_or_close ? close() : refuse_close();
    default:
      if (open_.empty() && token_.kind == Kind::end)
        return expected("JSON");
      return last_.kind == Kind::comma ? refuse_close() : expected("a value");
    }
  }

  void take_key() {
    if (token_.kind == Kind::text) {
      next_ = Next::colon;
      return check_text();
    }
    if (token_.kind == Kind::close_object)
      return next_ == Next::key_or_close ? close() : refuse_close();
    if (is_word() && last_.kind == Kind::comma &&
        std::isdigit(static_cast<unsigned char>(text_[token_.begin])))
      return expected("a key in double quotes (decimals have a point, not a comma)");
    return last_.kind == Kind::comma && !is_word() ? refuse_close() : expected("a key in double quotes");
  }

  // What cannot stand behind a comma, nor what closes nothing.
  void refuse_close() {
    const bool is_close = token_.kind == Kind::close_array || token_.kind == Kind::close_object;
    if (last_.kind == Kind::comma && is_close)
      return refuse(last_.begin, fmt::format("expected no comma before {}, found one", found()));
    if (last_.kind == Kind::comma && token_.kind == Kind::comma)
      return refuse(token_.begin, "expected one comma, found two");
    if (token_.kind == Kind::end)
      return refuse_end();
    expected(open_.empty() || open_.back().opened_by == Kind::open_array ? "a value"
                                                                         : "a key in double quotes");
  }

  void take_colon() {
    if (token_.kind != Kind::colon)
      return expected(fmt::format("a colon after the key {}", in_quotes(json_text_of(text_, last_))));
    next_ = Next::value;
  }

  void take_comma() {
    const bool in_object = open_.back().opened_by == Kind::open_object;
    if (token_.kind == Kind::comma) {
      next_ = in_object ? Next::key : Next::value;
      return;
    }
    if (token_.kind == (in_object ? Kind::close_object : Kind::close_array))
      return close();
    if (token_.kind == Kind::end)
      return refuse_end();
    if (token_.kind == Kind::close_object || token_.kind == Kind::close_array || token_.kind == Kind::colon)
      return expected(fmt::format("{} for the {} of line {}", in_object ? '}' : ']', in_object ? '{' : '[',
                                  line_of(open_.back().begin)));
    if (is_word() && last_.kind == Kind::word && !is_json_word(written(token_)))
      return expected(fmt::format("a comma or {} after {} (a number has no unit)", in_object ? '}' : ']',
                                  written(last_)));
    refuse(last_.end, fmt::format("expected a comma before {}, found none", found()));
  }

  void refuse_end() {
    const Container &open = open_.back();
    const bool is_object = open.opened_by == Kind::open_object;
    expected(fmt::format("{} for the {} of line {}", is_object ? '}' : ']', is_object ? '{' : '[',
                         line_of(open.begin)));
  }

  void check_text() {
    if (!token_.closed)
      return refuse(token_.begin,
                    "expected a double quote at the end of the text in the same line, found none");
    for (std::size_t at = token_.begin + 1; at + 1 < token_.end; ++at) {
      if (static_cast<unsigned char>(text_[at]) < 0x20)
        return refuse(at, text_[at] == '\t' ? "expected \\t in text, found a tab"
                                            : "expected no control characters in text, found one");
      if (text_[at] != '\\')
        continue;
      if (std::string_view("\"\\/bfnrtu").find(text_[at + 1]) == std::string_view::npos)
        return refuse(
            at, fmt::format("expected / in paths, or \\\\ for a backslash, found {}", text_.substr(at, 2)));
      ++at;
    }
  }

  void close() {
    open_.pop_back();
    after_value();
  }
  void after_value() { next_ = open_.empty() ? Next::end : Next::comma_or_close; }

  std::string_view text_;
  JsonTokens tokens_;
  bool comments_allowed_;
  JsonToken token_{Kind::end, 0, 0}, last_{Kind::end, 0, 0};
  Next next_ = Next::value;
  std::vector<Container> open_;
  std::optional<JsonProblem> problem_;
  bool done_ = false;
};

// Of which other encodings begin, or have as every second byte.
bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
         (text.size() > 1 && (text[0] == '\0' || text[1] == '\0'));
}

} // namespace

std::optional<JsonProblem> json_problem(std::string_view text, bool comments_allowed) {
  if (is_utf16(text))
    return JsonProblem{0, "expected UTF-8, found UTF-16: save the file as UTF-8"};
  return Reading(text, comments_allowed).problem();
}

} // namespace pmdsim
