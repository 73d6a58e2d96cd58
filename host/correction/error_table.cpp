#include "host/correction/error_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace pmdsim {
namespace {

constexpr std::array row_names{"interior", "edges", "partly in shadow"};
constexpr std::array figures{
    std::pair("mean", &ErrorFigures::mean_um), std::pair("rms", &ErrorFigures::rms_um),
    std::pair("median", &ErrorFigures::median_um), std::pair("95 %", &ErrorFigures::most_of_95_um),
    std::pair("max", &ErrorFigures::max_um)};

ErrorFigures figures_of(std::vector<double> errors_um) {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  if (errors_um.empty())
    return {not_a_number, not_a_number, not_a_number, not_a_number, not_a_number};
  const auto count = static_cast<double>(errors_um.size());
  double sum = 0.0, squares = 0.0;
  for (double &error : errors_um) {
    sum += error;
    squares += error * error;
    error = std::abs(error);
  }
  std::ranges::sort(errors_um);
  // The least that so many of all do not exceed.
  const auto quantile = [&](double share) {
    const double rank = std::ceil(share * count);
    return errors_um[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {sum / count, std::sqrt(squares / count), quantile(0.5), quantile(0.95), errors_um.back()};
}

std::optional<std::size_t> row_of_pixel(const CorrectedImage &corrected, const std::vector<double> &lit,
                                        std::size_t pixel) {
  const auto status = static_cast<PixelStatus>(corrected.status[pixel]);
  if (status != PixelStatus::corrected && status != PixelStatus::edge)
    return std::nullopt;
  if (!lit.empty() && lit[pixel] < 1.0)
    return 2;
  return status == PixelStatus::edge ? 1 : 0;
}

} // namespace

std::vector<ErrorRow> error_rows(const CorrectedImage &corrected, const std::vector<double> &true_range_m,
                                 const std::vector<double> &lit) {
  std::array<std::vector<double>, row_names.size()> before_um, after_um;
  for (std::size_t pixel = 0; pixel < true_range_m.size(); ++pixel) {
    const auto row = row_of_pixel(corrected, lit, pixel);
    if (!row || !std::isfinite(true_range_m[pixel]))
      continue;
    const double after_m = corrected.range_m[pixel] - true_range_m[pixel];
    after_um[*row].push_back(1e6 * after_m);
    before_um[*row].push_back(1e6 * (after_m + corrected.correction_m[pixel]));
  }
  std::vector<ErrorRow> rows;
  for (std::size_t row = 0; row < row_names.size(); ++row)
    if (!after_um[row].empty())
      rows.push_back(
          {row_names[row], after_um[row].size(), figures_of(before_um[row]), figures_of(after_um[row])});
  return rows;
}

std::size_t wrong_turns(const CorrectedImage &corrected, const std::vector<double> &true_range_m,
                        double ambiguity_m) {
  constexpr double near = 0.1;
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < true_range_m.size(); ++pixel) {
    const double turns = (corrected.range_m[pixel] - true_range_m[pixel]) / ambiguity_m;
    if (std::abs(turns) > 0.5 && std::abs(turns - std::round(turns)) < near)
      ++count;
  }
  return count;
}

std::string error_text(const std::vector<ErrorRow> &rows) {
  std::string text = fmt::format("{:<28}{:>9}", "", "pixels");
  for (const auto &[name, figure] : figures)
    text += fmt::format("{:>12}", name);
  for (const ErrorRow &row : rows)
    for (const bool is_before : {true, false}) {
      text +=
          fmt::format("\n{:<28}{:>9}", row.pixels + (is_before ? ", measured" : ", corrected"), row.count);
      for (const auto &[name, figure] : figures)
        text += fmt::format("{:>12.4g}", (is_before ? row.before : row.after).*figure);
    }
  return text + '\n';
}

nlohmann::ordered_json error_json(const std::vector<ErrorRow> &rows) {
  const auto json_of = [](const ErrorFigures &of) {
    return nlohmann::ordered_json{{"mean", of.mean_um},
                                  {"rms", of.rms_um},
                                  {"median", of.median_um},
                                  {"most_of_95_percent", of.most_of_95_um},
                                  {"max", of.max_um}};
  };
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ErrorRow &row : rows)
    list.push_back({{"of", row.pixels},
                    {"pixels", row.count},
                    {"measured_um", json_of(row.before)},
                    {"corrected_um", json_of(row.after)}});
  return list;
}

} // namespace pmdsim
