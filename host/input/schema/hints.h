#pragma once
// What people mean by keys and values that no schema knows, as the end of a message.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// Of a key where only `known` ones may stand: ", did you mean \"modulation_hz\", in hertz?". Empty where
// nothing is known of it.
std::string key_hint(std::string_view written, const std::vector<std::string> &known);

// Of text, likewise.
std::string text_hint(std::string_view written, const std::vector<std::string> &known);

// What to write where a number, true or false, or an array of numbers was expected, as `schema` says, and
// `value` was found: "; write [20000000.0]". Empty where nothing is known of it.
std::string value_hint(const nlohmann::json &schema, const nlohmann::json &value);

} // namespace pmdsim
