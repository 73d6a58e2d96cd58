#include "host/bench/table.h"

#include <cmath>
#include <limits>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

std::string row_text(const std::vector<std::string> &cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

} // namespace

std::string plain(const ordered_json &text) { return text.get<std::string>(); }

double number_or_nan(const ordered_json &value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::string number_text(const ordered_json &value, int digits) {
  const double known = number_or_nan(value);
  return std::isnan(known) ? "-" : fmt::format("{:.{}g}", known, digits);
}

std::string ms_text(const ordered_json &value) {
  const double ms = number_or_nan(value);
  return std::isnan(ms) ? "-" : fmt::format("{:.{}f}", ms, ms < 100 ? 2 : 0);
}

ordered_json value_at(const ordered_json &row, const std::string &pointer) {
  const ordered_json::json_pointer there(pointer);
  return row.contains(there) ? row.at(there) : ordered_json();
}

std::string table_text(const std::vector<Column> &columns, const ordered_json &rows) {
  std::vector<std::string> headings;
  for (const Column &column : columns)
    headings.push_back(column.heading);
  std::string text = row_text(headings) + row_text(std::vector<std::string>(columns.size(), "---"));
  for (const ordered_json &row : rows) {
    std::vector<std::string> cells;
    for (const Column &column : columns)
      cells.push_back(column.cell(row));
    text += row_text(cells);
  }
  return text;
}

} // namespace pmdsim
