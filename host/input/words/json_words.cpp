#include "host/input/words/json_words.h"

#include "host/input/words/quotes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <regex>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::size_t longest_word = 64; // that is looked at more closely

std::string lower(std::string_view word) {
  std::string text(word.substr(0, longest_word));
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// The value that Python, JavaScript and others write so.
std::optional<std::string> constant_meant(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> meant{
      {{"true", "true"},
       {"false", "false"},
       {"null", "null"},
       {"none", "null"},
       {"nil", "null"},
       {"undefined", "null"}}};
  const std::string written = lower(word);
  for (const auto &[name, value] : meant)
    if (written == name)
      return std::string(value);
  return std::nullopt;
}

bool is_not_finite(std::string_view word) {
  std::string written = lower(word);
  written.erase(0, written.find_first_not_of("+-"));
  return written == "nan" || written == "inf" || written == "infinity" || written == ".inf";
}

// Nothing where the word does not begin as a number does.
std::optional<std::string> wrong_number(std::string_view word) {
  if (word.size() > longest_word || word.find_first_of("0123456789") == word.npos)
    return std::nullopt;
  const std::string_view digits = word.substr(word.find_first_not_of("+-") == 1 ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() ||
      !(std::isdigit(static_cast<unsigned char>(digits.front())) || digits.front() == '.'))
    return std::nullopt;
  if (digits.starts_with("0x") || digits.starts_with("0X"))
    return "expected a decimal number";
  if (end != digits.data() + digits.size())
    return "expected a number alone, without a unit";
  if (word.starts_with('+'))
    return "expected a number without +";
  if (digits.front() == '.')
    return "expected a digit before the point, as 0.5";
  if (digits.starts_with('0') && digits.size() > 1)
    return "expected a number without leading zeros";
  return "expected a digit after the point, as 5.0";
}

} // namespace

bool is_json_word(std::string_view word) {
  static const std::regex number(R"(-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?)");
  constexpr std::size_t longest_number = 1000; // regex recurses
  return word == "true" || word == "false" || word == "null" || word.size() > longest_number ||
         std::regex_match(word.begin(), word.end(), number);
}

std::optional<std::string> foreign_word(std::string_view word) {
  if (word.starts_with('\'') || word.starts_with('`'))
    return fmt::format("expected text in double quotes, found {}",
                       word.front() == '`' ? "a backquote" : "a single quote");
  if (word.starts_with("\xe2\x80") || word.starts_with("\xc2\xab")) // curved quotes, guillemets
    return "expected straight double quotes, found typographic ones";
  if (word.starts_with('#'))
    return "expected a comment to begin with //, found #";
  return std::nullopt;
}

std::string wrong_value(std::string_view word) {
  if (const auto foreign = foreign_word(word))
    return *foreign;
  std::string expected = "expected text in double quotes, a number, true, false or null";
  if (const auto constant = constant_meant(word))
    expected = "expected " + *constant;
  else if (is_not_finite(word))
    expected = "expected a finite number";
  else if (const auto number = wrong_number(word))
    expected = *number;
  return fmt::format("{}, found {}", expected, in_quotes(word));
}

} // namespace pmdsim
