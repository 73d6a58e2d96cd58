#pragma once
// Checks a document against a JSON Schema and says in one line what is wrong, where, and what was expected.

#include <filesystem>
#include <nlohmann/json.hpp>

namespace pmdsim {

// A wrong key or value is thrown as Error (input) with its JSON pointer in `file`.
void check_schema(const nlohmann::json &document, const nlohmann::json &schema,
                  const std::filesystem::path &file);

} // namespace pmdsim
