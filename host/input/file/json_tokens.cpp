#include "host/input/file/json_tokens.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pmdsim {
namespace {

constexpr std::string_view blank_bytes = " \t\r\n";
constexpr std::string_view signs = "{}[]:,";
constexpr std::string_view mark = "\xef\xbb\xbf";

} // namespace

JsonTokens::JsonTokens(std::string_view text) : text_(text), at_(text.starts_with(mark) ? mark.size() : 0) {}

void JsonTokens::skip_blanks() {
  for (;;) {
    at_ = std::min(text_.find_first_not_of(blank_bytes, at_), text_.size());
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("//"))
      at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    else if (rest.starts_with("/*"))
      at_ = std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2;
    else
      return;
  }
}

JsonToken JsonTokens::text_token() {
  const std::size_t begin = at_;
  for (++at_; at_ < text_.size() && text_[at_] != '\n'; ++at_) {
    if (text_[at_] == '"')
      return {JsonToken::Kind::text, begin, ++at_};
    if (text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n')
      ++at_;
  }
  return {JsonToken::Kind::text, begin, at_, false};
}

JsonToken JsonTokens::next() {
  skip_blanks();
  if (at_ == text_.size())
    return {JsonToken::Kind::end, at_, at_};
  if (text_[at_] == '"')
    return text_token();
  const std::size_t begin = at_;
  if (const std::size_t sign = signs.find(text_[at_]); sign != signs.npos)
    return {static_cast<JsonToken::Kind>(sign), begin, ++at_};
  at_ = std::min(text_.find_first_of(" \t\r\n{}[]:,\"", at_), text_.size());
  const std::string_view word = text_.substr(begin, at_ - begin);
  at_ = begin + std::min({word.find("//", 1), word.find("/*", 1), word.size()}); // comments end it, too
  return {JsonToken::Kind::word, begin, at_};
}

std::string json_text_of(std::string_view text, const JsonToken &token) {
  const std::string_view written = text.substr(token.begin, token.end - token.begin);
  const auto read = nlohmann::json::parse(written, nullptr, false);
  return read.is_string() ? read.get<std::string>() : std::string(written);
}

} // namespace pmdsim
