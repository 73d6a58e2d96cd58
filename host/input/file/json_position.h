#pragma once
// Where in the text of a JSON document a value stands.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace pmdsim {

struct JsonPosition {
  std::size_t key;   // of its key or, in an array, of itself; bytes from the front of the text
  std::size_t value; // of its first byte
};

// Of the value that `pointer` names, the `occurrence`th of its key in its object. Up to it the text is valid
// JSON, perhaps with comments. Nothing where there is no such value.
std::optional<JsonPosition> position_in_json(std::string_view text,
                                             const nlohmann::json::json_pointer &pointer, int occurrence = 1);

} // namespace pmdsim
