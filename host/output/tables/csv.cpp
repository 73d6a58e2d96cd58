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
  std::string text(1, '"');
  for (const char c : value.get_ref<const std::string &>())
    text.append(c == '"' ? 2 : 1, c);
  return text + '"';
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

std::vector<ordered_json> flat_rows(const ordered_json &rows) {
  std::vector<ordered_json> lines;
  for (const ordered_json &row : rows)
    lines.push_back(flat(row));
  return lines;
}

} // namespace

std::string csv_text(const ordered_json &rows) {
  const std::vector<ordered_json> lines = flat_rows(rows);
  ordered_json keys = ordered_json::object();
  for (const ordered_json &line : lines)
    for (const auto &[key, value] : line.items())
      keys[key] = nullptr;
  std::string text;
  const auto add_line = [&](const auto &field_of) {
    std::vector<std::string> fields;
    for (const auto &[key, value] : keys.items())
      fields.push_back(field_of(key));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  };
  if (!lines.empty())
    add_line([](const std::string &key) {
      return key.find_first_of(",\"\n") == std::string::npos ? key : field(key);
    });
  for (const ordered_json &line : lines)
    add_line(
        [&](const std::string &key) { return line.contains(key) ? field(line.at(key)) : std::string(); });
  return text;
}

} // namespace pmdsim
