#pragma once
// Why a text is no JSON, in words for those who wrote it.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

struct JsonProblem {
  std::size_t at; // bytes from the front of the text
  std::string message;
};

// The first thing that is wrong with how the text is written, a trailing comma or single quotes, for
// example. Nothing where it is written well, and for numbers beyond double and bytes that are not UTF-8.
std::optional<JsonProblem> json_problem(std::string_view text, bool comments_allowed);

} // namespace pmdsim
