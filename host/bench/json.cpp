#include "host/bench/results.h"
#include "host/output/files/manifest.h"

#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json spread_json(const Spread &spread) {
  return {{"median", spread.median}, {"min", spread.min}, {"max", spread.max}};
}

// The largest error of all sensors and frequencies; NaN where nothing could be compared.
double largest_error_m(const std::vector<AccuracyCheck> &checks) {
  double largest_m = std::numeric_limits<double>::quiet_NaN();
  for (const AccuracyCheck &check : checks)
    largest_m = std::fmax(largest_m, check.distance_max_m);
  return largest_m;
}

// The keys that every row has.
ordered_json row_json(const std::string &name, Mode mode, const std::vector<TimedFrame> &frames,
                      double interactions_per_s, double error_found_m) {
  const Timing timing = timing_of(frames);
  const ordered_json accuracy = accuracy_json(timing.accuracy);
  return {{"name", name},
          {"mode", mode_name(mode)},
          {"precision", accuracy["precision"]},
          {"frame_ms", timing.frame_ms.median},
          {"frame_ms_min", timing.frame_ms.min},
          {"frame_ms_max", timing.frame_ms.max},
          {"frames_timed", frames.size()},
          {"frames_per_s", 1e3 / timing.frame_ms.median},
          {"interactions_per_s", interactions_per_s},
          {"passes_ms", passes_json(timing.passes)},
          {"passes_explain", timing.passes_explain},
          {"error_claimed_m", accuracy["error_claimed_m"]},
          {"error_found_m", error_found_m},
          {"accuracy", accuracy}};
}

ordered_json mode_json(const SetupBench &bench, const ModeBench &mode) {
  ordered_json json =
      row_json(bench.name, mode.mode, mode.frames, spread_of(interactions_per_s(bench, mode)).median,
               largest_error_m(mode.checks));
  json["first_frame_ms"] = mode.first_frame_ms;
  json["prepare_ms"] = or_null(mode.prepare_ms);
  for (const auto &[name, value] : mode.path)
    json["path"][name] = value;
  return json;
}

ordered_json swept_json(const SweepRow &row, Mode mode) {
  ordered_json json = row_json(row.point.name(), mode, row.frames,
                               interactions_per_s(row.frames, row.interactions, mode), row.error_m);
  json["sweep"] = row_of(row.point.quantity).name;
  json["value"] = row.point.value;
  json["checked_pixels"] = row.checked_pixels;
  json["first_frame_ms"] = row.first_frame_ms;
  json["prepare_ms"] = row.prepare_ms;
  json["peak_memory_bytes"] = or_null(row.peak_memory_bytes);
  return json;
}

ordered_json suite_json(const SuiteRow &row, Mode mode) {
  const AccuracyCheck &compared = row.check.compared;
  ordered_json json =
      row_json(row.name, mode, row.frames, interactions_per_s(row.frames, row.interactions, mode),
               compared.distance_max_m);
  json["triangles"] = row.triangles;
  json["first_frame_ms"] = row.first_frame_ms;
  json["prepare_ms"] = row.prepare_ms;
  for (const auto &[name, value] : row.path)
    json["path"][name] = value;
  json["check"] = {
      {"pixels", compared.resolution.y},           {"comparable", compared.comparable},
      {"same_triangles", compared.same_triangles}, {"pairs", compared.pairs},
      {"pairs_apart", compared.pairs_apart},       {"pairs_beyond_rounding", row.check.pairs_beyond_rounding},
      {"distances_compared", compared.pixels},     {"distances_off", compared.too_far}};
  if (const std::optional<double> speed = speed_over_peer(row))
    json["peer"] = {{"frame_ms", spread_json(spread_of(row.peer_frames_ms))}, {"speed_over_peer", *speed}};
  return json;
}

ordered_json results_json(const BenchReport &report) {
  ordered_json results = ordered_json::array();
  for (const ModeBench &mode : report.setup.modes)
    results.push_back(mode_json(report.setup, mode));
  for (const SweepRow &row : report.sweep)
    results.push_back(swept_json(row, report.request.accuracy.mode));
  for (const SuiteRow &row : report.suite)
    results.push_back(suite_json(row, report.request.accuracy.mode));
  return results;
}

ordered_json growth_json(const Growth &growth) {
  ordered_json points;
  for (std::size_t i = 0; i < growth.points.size(); ++i) {
    const auto &[size, ms] = growth.points[i];
    points.push_back({{"size", size},
                      {"frame_ms", ms},
                      {"marginal_ms", growth.marginal_ms[i]},
                      {"over_line", ms / growth.line.at_ms(size)}});
  }
  return {{"sweep", row_of(growth.quantity).name},
          {"unit", row_of(growth.quantity).unit},
          {"fixed_ms", growth.line.fixed_ms},
          {"slope_ms", growth.line.slope_ms},
          {"points", points}};
}

ordered_json native_json(const NativeBench &native) {
  const NativeKernel &kernel = native.kernel;
  ordered_json json = {{"interactions_per_s", spread_json(spread_of(native.moments_per_s))},
                       {"error_max_m", native.moments_error_m},
                       {"instructions", kernel.sums().instructions},
                       {"threads", kernel.threads()},
                       {"points", kernel.points()},
                       {"diodes", kernel.diodes()},
                       {"what", native.points},
                       {"series", nullptr}};
  if (native.series)
    json["series"] = {{"interactions_per_s", spread_json(spread_of(native.series_per_s))},
                      {"error_max_m", native.series_error_m},
                      {"powers", native.series->powers}};
  return json;
}

ordered_json knobs_json(const BenchReport &report) {
  const Accuracy &accuracy = report.request.accuracy;
  return {{"mode", report.request.one_mode ? mode_name(accuracy.mode) : "all"},
          {"precision", accuracy.precision ? ordered_json(precision_name(*accuracy.precision)) : nullptr},
          {"max_error_m", accuracy.max_error_m},
          {"samples", report.samples},
          {"environment", report.machine.environment}};
}

} // namespace

ordered_json bench_json(const BenchReport &report) {
  const Machine &machine = report.machine;
  ordered_json ratios = ordered_json::object(), spreads = ordered_json::object();
  for (const Ratio &ratio : ratios_of(report.setup)) {
    ratios[ratio.name] = ratio.value;
    spreads[ratio.name] = spread_json(ratio.of_rounds);
  }
  ordered_json json = {
      {"device", machine.device},
      {"driver", machine.driver},
      {"processor", machine.processor},
      {"hardware_threads", machine.hardware_threads},
      {"threads", machine.threads},
      {"build", {{"version", machine.version}, {"compiler", machine.compiler}, {"type", machine.build}}},
      {"command", report.command},
      {"knobs", knobs_json(report)},
      {"passes_by", machine.passes_by},
      {"results", results_json(report)},
      {"ratios", ratios},
      {"ratios_of_rounds", spreads},
      {"accumulate_looped_interactions_per_s", report.setup.looped_per_s.empty()
                                                   ? ordered_json()
                                                   : spread_json(spread_of(report.setup.looped_per_s))},
      {"native", report.setup.native ? native_json(*report.setup.native) : nullptr},
      {"peak_memory_bytes", or_null(report.setup.peak_memory_bytes)}};
  if (const std::optional<SequenceRate> &rate = report.sequence)
    json["sequence"] = {{"frames", rate->frames},
                        {"measured_per_s", rate->measured_per_s},
                        {"npy_per_s", rate->npy_per_s},
                        {"exr_per_s", rate->exr_per_s}};
  if (!report.sweep.empty())
    json["linearity"] = array_of(growths_of(report.sweep), growth_json);
  return json;
}

} // namespace pmdsim
