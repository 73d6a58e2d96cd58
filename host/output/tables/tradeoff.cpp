#include "host/output/tables/tradeoff.h"

#include "host/output/files/manifest.h"
#include "host/output/tables/csv.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

bool is_comparable(const TradeoffPoint &point) { return point.refusal.empty() && point.smooth.max_m; }

bool is_beaten_by(const TradeoffPoint &point, const TradeoffPoint &other) {
  const double time = point.time.median_ms, other_time = other.time.median_ms;
  const double error = *point.smooth.max_m, other_error = *other.smooth.max_m;
  return other_time <= time && other_error <= error && (other_time < time || other_error < error);
}

ordered_json null_unless(bool there, const ordered_json &value) { return there ? value : nullptr; }

ordered_json point_json(const TradeoffPoint &point) {
  const bool measured = point.refusal.empty();
  return {{"sweep", point.sweep == Sweep::modes ? "modes" : "samples"},
          {"mode", mode_name(point.accuracy.mode)},
          {"max_error_m", null_unless(point.accuracy.mode != Mode::exact, point.accuracy.max_error_m)},
          {"precision", null_unless(measured, precision_name(point.report.precision))},
          {"diodes", null_unless(measured, point.report.diodes)},
          {"samples", point.adaptive_samples ? ordered_json("auto") : ordered_json(point.samples)},
          {"reference_samples", point.reference_samples},
          {"frame_ms", null_unless(measured, point.time.median_ms)},
          {"frame_ms_min", null_unless(measured, point.time.min_ms)},
          {"frame_ms_max", null_unless(measured, point.time.max_ms)},
          {"pixels", point.smooth.pixels},
          {"error_max_m", or_null(point.smooth.max_m)},
          {"error_rms_m", or_null(point.smooth.rms_m)},
          {"edge_pixels", point.edges.pixels},
          {"edge_error_max_m", or_null(point.edges.max_m)},
          {"edge_error_rms_m", or_null(point.edges.rms_m)},
          {"error_claimed_m", or_null(point.report.claimed_m)},
          {"error_found_m", or_null(point.report.found_m)},
          {"check_ms", null_unless(point.report.checked_pixels > 0, point.report.check_ms)},
          {"pareto", point.pareto},
          {"refused", null_unless(!measured, point.refusal)}};
}

std::string length_text(double length_m) {
  return length_m < 1e-3 ? fmt::format("{:.6g} µm", 1e6 * length_m)
                         : fmt::format("{:.6g} mm", 1e3 * length_m);
}

using Cells = std::vector<std::string>;

// The value with `digits` digits at least, and no exponent where there are more.
std::string with_digits(double value, int digits) {
  return value < std::pow(10.0, digits) ? fmt::format("{:.{}g}", value, digits)
                                        : fmt::format("{:.0f}", value);
}

std::string milliseconds(double time_ms) { return with_digits(time_ms, 4); }

std::string micrometres(const std::optional<double> &length_m) {
  return length_m ? with_digits(1e6 * *length_m, 3) : "-";
}

const Cells header{"mode",      "asked",         "precision",   "diodes",  "S",
                   "frame, ms", "least to most", "largest, µm", "RMS, µm", "edges, µm",
                   "RMS, µm",   "claimed, µm",   "front"};

std::string samples_text(const TradeoffPoint &point) {
  return point.adaptive_samples ? "auto" : fmt::format("{}", point.samples);
}

Cells cells_of(const TradeoffPoint &point) {
  const bool bounded = point.accuracy.mode != Mode::exact;
  Cells cells{mode_name(point.accuracy.mode), bounded ? length_text(point.accuracy.max_error_m) : "-"};
  if (!point.refusal.empty()) {
    cells.insert(cells.end(), {"-", "-", samples_text(point), "refused"});
    cells.resize(header.size(), "-");
    return cells;
  }
  const FrameTime &time = point.time;
  cells.insert(cells.end(), {precision_name(point.report.precision), fmt::format("{}", point.report.diodes),
                             samples_text(point), milliseconds(time.median_ms),
                             milliseconds(time.min_ms) + " to " + milliseconds(time.max_ms),
                             micrometres(point.smooth.max_m), micrometres(point.smooth.rms_m),
                             micrometres(point.edges.max_m), micrometres(point.edges.rms_m),
                             micrometres(point.report.claimed_m), point.pareto ? "front" : ""});
  return cells;
}

std::vector<Cells> rows_of(const std::vector<TradeoffPoint> &points) {
  std::vector<Cells> rows{header};
  std::ranges::transform(points, std::back_inserter(rows), cells_of);
  return rows;
}

// The characters of UTF-8: its bytes less those that continue a character.
std::size_t characters(const std::string &text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) != 0x80u; }));
}

// Columns as wide as their widest cell, numbers on the right.
std::string padded(const std::vector<Cells> &rows) {
  std::string text;
  for (const Cells &row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::size_t width = 0;
      for (const Cells &other : rows)
        width = std::max(width, characters(other[i]));
      line += i == 0 ? fmt::format("{:<{}}", row[i], width) : fmt::format("  {:>{}}", row[i], width);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string piped(const std::vector<Cells> &rows) {
  std::string text;
  for (const Cells &row : rows) {
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
    for (std::size_t i = 0; &row == &rows.front() && i <= row.size(); ++i)
      text += i < row.size() ? "|---" : "|\n";
  }
  return text;
}

// The sentence above the table of a sweep's points.
std::string caption(const std::vector<TradeoffPoint> &points) {
  const TradeoffPoint &first = points.front(); // all have its reference
  const auto measured = std::ranges::find(points, "", &TradeoffPoint::refusal);
  const std::string pixels = measured == points.end()
                                 ? ""
                                 : fmt::format(", {} random pixels beside edges and {} on them",
                                               measured->smooth.pixels, measured->edges.pixels);
  return fmt::format("{}: largest and RMS distance error against the reference in double, S = {}{}",
                     first.sweep == Sweep::modes ? "modes and precisions" : "samples",
                     first.reference_samples, pixels);
}

template <class Table>
std::string tables(const Tradeoff &tradeoff, const Table &table) {
  std::string text;
  for (const Sweep sweep : {Sweep::modes, Sweep::samples}) {
    std::vector<TradeoffPoint> points;
    std::ranges::copy_if(tradeoff.points, std::back_inserter(points),
                         [&](const TradeoffPoint &point) { return point.sweep == sweep; });
    if (!points.empty())
      text += (text.empty() ? "" : "\n") + caption(points) + "\n\n" + table(rows_of(points));
  }
  for (const TradeoffPoint &point : tradeoff.points)
    if (!point.refusal.empty())
      text += fmt::format("\nrefused: {}, {}: {}\n", series_name(point), point_label(point), point.refusal);
  return text;
}

} // namespace

void mark_pareto(std::vector<TradeoffPoint> &points) {
  for (TradeoffPoint &point : points)
    point.pareto = is_comparable(point) && std::ranges::none_of(points, [&](const TradeoffPoint &other) {
                     return other.sweep == point.sweep && is_comparable(other) && is_beaten_by(point, other);
                   });
}

ordered_json tradeoff_json(const Tradeoff &tradeoff) {
  return {{"setup", tradeoff.setup},
          {"sensor", tradeoff.sensor},
          {"device", tradeoff.device},
          {"driver", tradeoff.driver},
          {"points", array_of(tradeoff.points, point_json)}};
}

std::string tradeoff_csv(const Tradeoff &tradeoff) { return csv_text(array_of(tradeoff.points, point_json)); }

std::string tradeoff_text(const Tradeoff &tradeoff) { return tables(tradeoff, padded); }

std::string tradeoff_markdown(const Tradeoff &tradeoff) {
  return fmt::format("`pmdsim tradeoff {}`, sensor {}, on {} ({})\n\n", tradeoff.setup, tradeoff.sensor,
                     tradeoff.device, tradeoff.driver) +
         tables(tradeoff, piped);
}

std::string series_name(const TradeoffPoint &point) {
  return point.sweep == Sweep::samples ? "samples" : mode_name(point.accuracy.mode);
}

std::string point_label(const TradeoffPoint &point) {
  if (point.sweep == Sweep::samples)
    return "S = " + samples_text(point);
  return point.accuracy.mode == Mode::exact
             ? precision_name(point.accuracy.precision.value_or(Precision::fp32))
             : length_text(point.accuracy.max_error_m);
}

} // namespace pmdsim
