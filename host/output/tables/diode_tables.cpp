#include "host/output/tables/diode_tables.h"

#include "host/output/files/manifest.h"
#include "host/output/tables/csv.h"

#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json change_json(const ImageChange &change) {
  return {{"rms_um", um_per_m * change.rms_m},
          {"max_um", um_per_m * change.max_m},
          {"varying_rms_um", um_per_m * change.varying_rms_m},
          {"varying_max_um", um_per_m * change.varying_max_m}};
}

// A row for each diode, in their order.
ordered_json diode_rows(const DiodeStudy &study) {
  std::vector<std::size_t> rank(study.diodes.size());
  const std::vector<std::size_t> ranking = study.ranking();
  for (std::size_t i = 0; i < ranking.size(); ++i)
    rank[ranking[i]] = i + 1;
  ordered_json rows = ordered_json::array();
  for (std::size_t m = 0; m < study.diodes.size(); ++m) {
    const StudiedDiode &diode = study.diodes[m];
    const DiodeEffect &effect = study.theory.diodes[m];
    ordered_json row{{"illuminator", diode.illuminator},
                     {"diode", diode.number},
                     {"x_m", diode.position_m.x},
                     {"y_m", diode.position_m.y},
                     {"z_m", diode.position_m.z},
                     {"light_share", effect.light_share},
                     {"rank", rank[m]},
                     {"board_rms_um", um_per_m * effect.in_board.rms_m},
                     {"board_varying_rms_um", um_per_m * effect.in_board.varying_rms_m}};
    for (std::size_t i = 0; i < fault_count; ++i)
      row[fault_names[i]] = change_json(effect.faults[i]);
    row["left_dark"] = effect.left_dark;
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json board_rows(const DiodeStudy &study) {
  ordered_json rows = ordered_json::array();
  const RandomBoards &random = study.random;
  for (std::size_t kind = 0; kind <= kind_count; ++kind) {
    const bool is_all = kind == kind_count;
    const Deviation &theory = study.theory.board[kind], &here = random.theory[kind];
    const BoardStatistics &found = random.found[kind];
    rows.push_back({{"errors", is_all ? "all" : kind_names[kind]},
                    {"tolerance", is_all ? "" : tolerance_text(static_cast<Kind>(kind), study.tolerances)},
                    {"linear_rms_um", um_per_m * theory.rms_m},
                    {"linear_varying_rms_um", um_per_m * theory.varying_rms_m},
                    {"linear_rms_there_um", um_per_m * here.rms_m},
                    {"linear_varying_rms_there_um", um_per_m * here.varying_rms_m},
                    {"monte_carlo_rms_um", um_per_m * found.rms_m},
                    {"monte_carlo_varying_rms_um", um_per_m * found.varying_rms_m},
                    {"ratio", found.rms_m / here.rms_m},
                    {"ratio_standard_error", found.standard_error},
                    {"varying_ratio", found.varying_rms_m / here.varying_rms_m},
                    {"varying_ratio_standard_error", found.varying_standard_error},
                    {"boards_95_percent_um", um_per_m * found.most_rms_m},
                    {"boards_95_percent_varying_um", um_per_m * found.most_varying_rms_m}});
  }
  return rows;
}

ordered_json alike_rows(const DiodeStudy &study) {
  ordered_json rows = ordered_json::array();
  for (std::size_t light = 0; light < study.illuminators.size(); ++light)
    for (std::size_t i = 0; i < slope_count; ++i) {
      const auto fault = static_cast<Fault>(i);
      ordered_json row{{"illuminator", study.illuminators[light]},
                       {"error", fault_names[i]},
                       {"size", tolerance_text(kind_of(fault), study.tolerances)}};
      row.update(change_json(study.theory.alike[light][i]));
      rows.push_back(std::move(row));
    }
  return rows;
}

ordered_json pixel_rows(const DiodeStudy &study) {
  ordered_json rows = ordered_json::array();
  const RandomBoards &random = study.random;
  for (std::size_t i = 0; i < random.points.size(); ++i) {
    const glm::uvec2 &pixel = study.pixels[random.points[i]];
    const PointStatistics &found = random.statistics[i];
    rows.push_back({{"column", pixel.x},
                    {"row", pixel.y},
                    {"weight", random.weights[i]},
                    {"linear_deviation_um", um_per_m * random.theory_m[i]},
                    {"monte_carlo_deviation_um", um_per_m * found.deviation_m},
                    {"ratio", found.deviation_m / random.theory_m[i]},
                    {"mean_um", um_per_m * found.mean_m},
                    {"low_2.5_percent_um", um_per_m * found.low_m},
                    {"median_um", um_per_m * found.median_m},
                    {"high_97.5_percent_um", um_per_m * found.high_m}});
  }
  return rows;
}

ordered_json tolerances_json(const Tolerances &tolerances) {
  const double degrees = 180.0 / std::numbers::pi;
  return {{"position_m", tolerances.position_m},
          {"axis_deg", degrees * tolerances.axis_rad},
          {"intensity", tolerances.intensity},
          {"phase_deg", degrees * tolerances.phase_rad},
          {"dead", tolerances.dead},
          {"law", tolerances.law == ErrorLaw::gaussian ? "gaussian" : "uniform"}};
}

} // namespace

ordered_json diode_study_json(const DiodeStudy &study) {
  return {{"sensor", study.sensor},
          {"modulation_hz", study.modulation_hz},
          {"pixels", {study.grid.x, study.grid.y}},
          {"lit_pixels", study.theory.lit_points},
          {"tolerances", tolerances_json(study.tolerances)},
          {"boards", study.random.boards},
          {"seed", study.random.seed},
          {"boards_pixels", study.random.points.size()},
          {"board", board_rows(study)},
          {"alike", alike_rows(study)},
          {"diodes", diode_rows(study)}};
}

std::string diodes_csv(const DiodeStudy &study) { return csv_text(diode_rows(study)); }
std::string board_csv(const DiodeStudy &study) { return csv_text(board_rows(study)); }
std::string alike_csv(const DiodeStudy &study) { return csv_text(alike_rows(study)); }
std::string pixels_csv(const DiodeStudy &study) { return csv_text(pixel_rows(study)); }

} // namespace pmdsim
