#include "host/capture/variant_table.h"

#include "host/input/words/utf8.h"
#include "host/output/files/channel.h"
#include "host/output/files/output_set.h"
#include "host/output/tables/csv.h"
#include "host/report/report.h"

#include <cmath>
#include <fmt/format.h>
#include <span>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t most_lines = 40; // for people

ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : nullptr; }

void put_spread(const std::string &quantity, const std::string &unit, const std::vector<float> &values,
                ordered_json &summary) {
  const Spread spread = spread_of(values);
  summary[quantity + "_min" + unit] = number(spread.min);
  summary[quantity + "_median" + unit] = number(spread.median);
  summary[quantity + "_max" + unit] = number(spread.max);
}

// NaN counts as nothing.
ordered_json mean_of(const std::vector<float> &values) {
  double sum = 0.0;
  for (const float value : values)
    sum += std::isnan(value) ? 0.0 : static_cast<double>(value);
  return values.empty() ? nullptr : number(sum / static_cast<double>(values.size()));
}

std::string shown(const ordered_json &value) {
  return value.is_number() ? table_number(value.get<double>())
         : value.is_null() ? "-"
                           : in_one_line(value.dump());
}

// A record that others wrote may tell of what the row says already.
ordered_json without_keys_of(const ordered_json &row, ordered_json told) {
  for (const auto &[key, value] : row.items())
    told.erase(key);
  return told;
}

} // namespace

ordered_json frame_summary(const Measurement &frame) {
  ordered_json summary = ordered_json::object();
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    const auto frequency = frequency_of(i, frame.returns.size());
    put_spread(channel_name("distance", frequency), "_m", frame.returns[i].distance_m, summary);
    put_spread(channel_name("amplitude", frequency), "", frame.returns[i].amplitude, summary);
  }
  put_spread("range", "_m", frame.range_m, summary);
  summary["coverage_mean"] = mean_of(frame.coverage);
  return summary;
}

VariantTable::VariantTable(const std::vector<Variant> &variants) : no_changes_(ordered_json::object()) {
  for (const Variant &variant : variants)
    for (const auto &[path, value] : variant.changes.items())
      no_changes_[path] = nullptr;
}

void VariantTable::add(const Variant &variant, const ordered_json &of_sensor) {
  const ordered_json &of = of_sensor.at("manifest");
  ordered_json row{{"variant", variant.name}};
  row.update(no_changes_);
  for (const auto &[path, value] : variant.changes.items())
    row[path] = value.is_structured() ? ordered_json(value.dump()) : ordered_json(value);
  row["variant"] = variant.name; // a change of that name is none of the setup's
  for (const char *key : {"sensor", "frame", "time_s"})
    row[key] = of.at(key);
  if (of_sensor.contains("told"))
    row.update(without_keys_of(row, of_sensor.at("told")));
  row["error_claimed_m"] = of.at("error_claimed_m");
  rows_.push_back(std::move(row));
}

std::string VariantTable::write(const std::filesystem::path &directory, const std::string &name) const {
  OutputSet files(directory);
  files.add(name, [&](OutputFile &file) { file.write(csv_text(rows_)); });
  files.publish();
  return (directory / name).string();
}

std::string VariantTable::text() const {
  std::string text = fmt::format("{:<24}{:<12}{:>6}{:>14}{:>14}{:>14}{:>14}\n", "variant", "sensor", "frame",
                                 "distance min", "median", "max, m", "amplitude");
  for (std::size_t i = 0; i < rows_.size() && i < most_lines; ++i) {
    const ordered_json &row = rows_[i];
    const std::string first = row.contains("distance_min_m") ? "" : "f0.";
    text +=
        fmt::format("{:<24}{:<12}{:>6}", row.at("variant").get<std::string>(),
                    in_one_line(row.at("sensor").get<std::string>()), row.at("frame").get<std::uint32_t>());
    for (const char *key : {"distance_min_m", "distance_median_m", "distance_max_m", "amplitude_median"})
      text += fmt::format("{:>14}", shown(row.value(first + key, ordered_json())));
    text += '\n';
  }
  if (rows_.size() > most_lines)
    text += fmt::format("and {} rows more\n", rows_.size() - most_lines);
  return text;
}

} // namespace pmdsim
