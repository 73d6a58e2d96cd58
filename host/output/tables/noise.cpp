#include "host/output/tables/noise.h"

#include "host/output/files/manifest.h"
#include "host/output/tables/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json shares_json(const NoiseShares &shares) {
  return {{"shot", shares.shot},
          {"background", shares.background},
          {"dark", shares.dark},
          {"read", shares.read},
          {"adc", shares.adc}};
}

ordered_json transfer_json(const TransferPoint &point) {
  return {{"signal_e", point.signal_e},
          {"mean_dn", point.mean_dn},
          {"variance_dn2", point.variance_dn2},
          {"found_mean_dn", point.found_mean_dn},
          {"found_variance_dn2", point.found_variance_dn2},
          {"full", point.is_full}};
}

ordered_json precision_json(const PrecisionPoint &point) {
  return {{"reflectivity", point.reflectivity},
          {"distance_m", point.distance_m},
          {"signal_e", point.signal_e},
          {"full", point.is_full},
          {"distance_noise_m", or_null(point.predicted_m)},
          {"found_noise_m", or_null(point.found_m)},
          {"variance_shares", shares_json(point.shares)},
          {"limited_by", limiting_noise(point.shares)}};
}

std::string millimetres_text(const PrecisionPoint &point) {
  if (point.is_full)
    return "full";
  return point.predicted_m
             ? fmt::format("{:.3g} mm, {}", 1e3 * *point.predicted_m, limiting_noise(point.shares))
             : "-";
}

} // namespace

std::string limiting_noise(const NoiseShares &shares) {
  const std::array<std::pair<double, const char *>, 5> kinds{{{shares.shot, "shot"},
                                                              {shares.background, "background"},
                                                              {shares.dark, "dark current"},
                                                              {shares.read, "read"},
                                                              {shares.adc, "ADC"}}};
  return std::ranges::max_element(kinds, {}, &std::pair<double, const char *>::first)->second;
}

ordered_json noise_json(const std::vector<NoiseStudy> &studies) {
  const auto json_of = [](const NoiseStudy &study) {
    return ordered_json{{"sensor", study.sensor},
                        {"modulation_hz", study.modulation_hz},
                        {"ambiguity_m", study.ambiguity_m},
                        {"photon_transfer", array_of(study.transfer, transfer_json)},
                        {"precision", array_of(study.precision, precision_json)}};
  };
  return {{"noise", array_of(studies, json_of)}};
}

std::string transfer_csv(const std::vector<NoiseStudy> &studies) {
  ordered_json rows = ordered_json::array();
  for (const NoiseStudy &study : studies)
    for (const TransferPoint &point : study.transfer)
      rows.emplace_back(ordered_json{{"sensor", study.sensor}}).update(transfer_json(point));
  return csv_text(rows);
}

std::string precision_csv(const std::vector<NoiseStudy> &studies) {
  ordered_json rows = ordered_json::array();
  for (const NoiseStudy &study : studies)
    for (const PrecisionPoint &point : study.precision)
      rows.emplace_back(ordered_json{{"sensor", study.sensor}, {"modulation_hz", study.modulation_hz}})
          .update(precision_json(point));
  return csv_text(rows);
}

std::string noise_text(const NoiseStudy &study) {
  std::set<double> reflectivities, distances_m;
  for (const PrecisionPoint &point : study.precision) {
    reflectivities.insert(point.reflectivity);
    distances_m.insert(point.distance_m);
  }
  std::string text = fmt::format("{:<12}", "distance");
  for (const double reflectivity : reflectivities)
    text += fmt::format("{:<26}", fmt::format("reflectivity {:.3g}", reflectivity));
  text += "\n";
  constexpr std::size_t every = 4; // of the distances
  std::size_t row = 0;
  for (const double distance_m : distances_m) {
    if (row++ % every != 0)
      continue;
    text += fmt::format("{:<12}", fmt::format("{:.3g} m", distance_m));
    for (const PrecisionPoint &point : study.precision)
      if (point.distance_m == distance_m)
        text += fmt::format("{:<26}", millimetres_text(point));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

} // namespace pmdsim
