#pragma once
// Tables for programs: the same rows in JSON and CSV.

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim {

// Of an array of objects: a header line of all their keys, in the order in which they come, then a line a
// row; nothing without rows. An object within a row is a column for each of its keys, KEY.ITS_KEY; null, and
// a key that a row has not, is an empty field.
std::string csv_text(const nlohmann::ordered_json &rows);

} // namespace pmdsim
