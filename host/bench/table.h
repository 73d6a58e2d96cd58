#pragma once
// Tables in Markdown whose rows are JSON.

#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// Texts of a cell. NaN and null are "-".
std::string plain(const nlohmann::ordered_json &text);
double number_or_nan(const nlohmann::ordered_json &value);
// `digits` significant ones.
std::string number_text(const nlohmann::ordered_json &value, int digits);
std::string ms_text(const nlohmann::ordered_json &value);

template <int digits>
std::string number(const nlohmann::ordered_json &value) {
  return number_text(value, digits);
}

struct Column {
  std::string heading;
  std::function<std::string(const nlohmann::ordered_json &row)> cell;
};

// The value at `pointer` in the row; null where there is none.
nlohmann::ordered_json value_at(const nlohmann::ordered_json &row, const std::string &pointer);

Column column(const std::string &heading, const std::string &pointer, const auto &text) {
  return {heading, [=](const nlohmann::ordered_json &row) { return text(value_at(row, pointer)); }};
}

Column from_to(const std::string &heading, const std::string &least, const std::string &most,
               const auto &text) {
  return {heading, [=](const nlohmann::ordered_json &row) {
            return fmt::format("{} to {}", text(value_at(row, least)), text(value_at(row, most)));
          }};
}

std::string table_text(const std::vector<Column> &columns, const nlohmann::ordered_json &rows);

} // namespace pmdsim
