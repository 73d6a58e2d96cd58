#pragma once
// Tables for programs: the same rows in JSON and CSV.

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim {

// Of an array of objects with the same keys: a header line of the keys, then a line a row; nothing without
// rows. An object within a row is a column for each of its keys, KEY.ITS_KEY; null is an empty field.
std::string csv_text(const nlohmann::ordered_json &rows);

} // namespace pmdsim
