#include "host/output/tables/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

std::string field(const ordered_json &value) {
  if (value.is_null())
    return "";
  if (!value.is_string())
    return value.dump();
  std::string text = value;
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

ordered_json flat(const ordered_json &row) {
  ordered_json columns;
  for (const auto &[key, value] : row.items()) {
    if (value.is_object())
      for (const auto &[inner_key, inner] : value.items())
        columns[fmt::format("{}.{}", key, inner_key)] = inner;
    else
      columns[key] = value;
  }
  return columns;
}

} // namespace

std::string csv_text(const ordered_json &rows) {
  std::string text;
  for (const ordered_json &row : rows) {
    std::vector<std::string> keys, fields;
    const ordered_json columns = flat(row);
    for (const auto &[key, value] : columns.items()) {
      keys.push_back(key);
      fields.push_back(field(value));
    }
    if (text.empty())
      text = fmt::format("{}\n", fmt::join(keys, ","));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

} // namespace pmdsim
