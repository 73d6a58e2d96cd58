#pragma once
// What stands in JSON without quotes: numbers, true, false and null; and what people write instead.

#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

bool is_json_word(std::string_view word);

// What is wrong with a word wherever it stands: another language's quotes or comments. Nothing where nothing
// is known of it.
std::optional<std::string> foreign_word(std::string_view word);

// What was expected in place of a word that is no value, and what was found.
std::string wrong_value(std::string_view word);

} // namespace pmdsim
