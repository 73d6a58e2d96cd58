#include "engine/error.h"
#include "host/commands/accuracy_check.h"
#include "host/commands/commands.h"
#include "host/commands/exposure.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/progress_bar.h"
#include "host/commands/report.h"
#include "host/commands/timing.h"
#include "host/output/manifest.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <optional>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// Of one mode.
struct Row {
  Mode mode = Mode::exact;
  Timing timing;                     // of all sensors
  std::vector<AccuracyCheck> checks; // none of the reference itself
};

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

// Of all sensors and exposures.
double interaction_count(const Setup &setup) {
  return samples_of_frame(setup) * static_cast<double>(diode_count(setup.start.illuminators));
}

Timing time_all_sensors(const Setup &setup, Exposures &exposures, const std::string &mode) {
  ProgressBar bar((1 + measured_frames) * samples_of_frame(setup));
  std::optional<Timing> sum;
  for (std::size_t sensor = 0; sensor < setup.start.sensors.size(); ++sensor) {
    const Timing timing = time_frames([&](const std::string &label) {
      bar.begin(fmt::format("mode {}, {}", mode, label),
                samples_of_frame(setup, setup.start.sensors[sensor]));
      return exposures.take(sensor, setup.frames.start_s, Light::beside_lens, interruptible_progress(bar))
          .measurement;
    });
    if (sum)
      add(*sum, timing);
    else
      sum = timing;
  }
  return *sum;
}

// NaN where not every sample meets every diode in the accumulate pass.
double interactions_per_s(const Setup &setup, Mode mode, const Timing &timing) {
  if (mode != Mode::exact || std::ranges::any_of(setup.start.sensors, &Sensor::adaptive_samples))
    return std::numeric_limits<double>::quiet_NaN();
  const auto accumulate = std::ranges::find(timing.passes, "accumulate", &PassTime::name);
  return accumulate == timing.passes.end() ? std::numeric_limits<double>::quiet_NaN()
                                           : interaction_count(setup) / (1e-3 * accumulate->ms);
}

double frames_per_s(const Timing &timing) { return 1e3 / timing.frame_ms.median; }

// The largest of all sensors and frequencies; NaN where nothing could be compared.
double largest_error_m(const std::vector<AccuracyCheck> &checks) {
  double largest_m = std::numeric_limits<double>::quiet_NaN();
  for (const AccuracyCheck &check : checks)
    largest_m = std::fmax(largest_m, check.distance_max_m);
  return largest_m;
}

ordered_json row_json(const Setup &setup, const Row &row) {
  const auto &[mode, timing, checks] = row;
  const ordered_json accuracy = accuracy_json(timing.accuracy);
  return {{"name", "setup"},
          {"mode", mode_name(mode)},
          {"precision", accuracy["precision"]},
          {"frame_ms", timing.frame_ms.median},
          {"frame_ms_min", timing.frame_ms.min},
          {"frame_ms_max", timing.frame_ms.max},
          {"frames_per_s", frames_per_s(timing)},
          {"interactions_per_s", interactions_per_s(setup, mode, timing)},
          {"passes_ms", passes_json(timing.passes)},
          {"error_claimed_m", accuracy["error_claimed_m"]},
          {"error_found_m", largest_error_m(checks)},
          {"accuracy", accuracy}};
}

// How many times as fast as mode exact each other mode's frame is.
ordered_json ratios_json(const std::vector<Row> &rows) {
  ordered_json ratios = ordered_json::object();
  for (const Row &row : rows)
    if (row.mode != Mode::exact && rows.front().mode == Mode::exact)
      ratios[fmt::format("exact_frame_over_{}_frame", mode_name(row.mode))] =
          rows.front().timing.frame_ms.median / row.timing.frame_ms.median;
  return ratios;
}

ordered_json report_json(const Setup &setup, const Camera &camera, const std::vector<Row> &rows) {
  ordered_json results = ordered_json::array();
  for (const Row &row : rows)
    results.push_back(row_json(setup, row));
  return {{"device", camera.device()},
          {"driver", camera.driver()},
          {"processor", processor_name()},
          {"results", results},
          {"ratios", ratios_json(rows)}};
}

std::string error_text(const AccuracyCheck &check) {
  const std::string what = fmt::format("{}, {}: ", check.sensor, frequency_text(check.modulation_hz));
  if (check.comparable == 0)
    return what + "nothing to compare, the reference is dark in every pixel";
  if (check.pixels == 0)
    return what + "nothing to compare, rounding decides about the light of every pixel";
  return what + fmt::format("at most {:.4g} µm over {} pixels of {} x {}, against the reference",
                            1e6 * check.distance_max_m, check.pixels, check.resolution.x, check.resolution.y);
}

std::string row_text(const Setup &setup, const Row &row) {
  const auto &[mode, timing, checks] = row;
  const std::string sensors =
      setup.start.sensors.size() > 1 ? fmt::format(" of each of {} sensors", setup.start.sensors.size()) : "";
  std::string text = fmt::format("\nmode       {}\n", sum_text(mode, timing.accuracy));
  if (const std::string errors = errors_text(timing.accuracy); !errors.empty())
    text += fmt::format("error      {}\n", errors);
  for (const AccuracyCheck &check : checks)
    text += fmt::format("error      {}\n", error_text(check));
  text += fmt::format("frame      {:.3f} ms ({:.3f} to {:.3f} in {} warm frames{}), {:.4g} frames/s\n",
                      timing.frame_ms.median, timing.frame_ms.min, timing.frame_ms.max, measured_frames,
                      sensors, frames_per_s(timing));
  for (const PassTime &pass : timing.passes)
    text += fmt::format("  {:<20}{:>10.3f} ms\n", pass.name, pass.ms);
  if (const double rate = interactions_per_s(setup, mode, timing); !std::isnan(rate))
    text += fmt::format("rate       {:.4g} interactions/s in the accumulate pass\n", rate);
  return text;
}

std::string report_text(const Setup &setup, const Camera &camera, const std::vector<Row> &rows) {
  std::string text =
      fmt::format("device     {} ({})\nprocessor  {}\n", camera.device(), camera.driver(), processor_name());
  for (const Row &row : rows)
    text += row_text(setup, row);
  return text;
}

// The one that is asked for, else all that there are.
std::vector<Mode> modes_of(const Options &options, const Setup &setup) {
  if (options.mode_written)
    return {options.accuracy.mode};
  const bool only_exact = names_the_reference(options.device) || exposes_any_tap_by_tap(setup);
  return only_exact ? std::vector{Mode::exact} : std::vector{Mode::exact, Mode::reduced, Mode::automatic};
}

Row bench_mode(const Setup &setup, const Camera &camera, const std::vector<ReferenceFrame> &truth,
               const std::string &device, const Accuracy &accuracy) {
  Row row{.mode = accuracy.mode, .timing = {}, .checks = check_accuracy(setup, truth, device, accuracy)};
  for (const AccuracyCheck &check : row.checks)
    require_plausible(check, fmt::format("{}, mode {}", camera.device(), mode_name(accuracy.mode)));
  Exposures exposures(setup, device, false, accuracy);
  row.timing = time_all_sensors(setup, exposures, mode_name(accuracy.mode));
  return row;
}

// A mode that cannot keep its error is an error only where it was asked for.
std::vector<Row> bench_modes(const Setup &setup, const Camera &camera, const Options &options) {
  const std::vector<ReferenceFrame> truth =
      camera.is_reference() ? std::vector<ReferenceFrame>() : reference_frames(setup);
  std::vector<Row> rows;
  for (const Mode mode : modes_of(options, setup)) {
    Accuracy accuracy = options.accuracy;
    accuracy.mode = mode;
    try {
      rows.push_back(bench_mode(setup, camera, truth, options.device, accuracy));
    } catch (const Error &error) {
      if (options.mode_written || error.code() != ExitCode::accuracy)
        throw;
      fmt::print(stderr, "pmdsim: warning: mode {} is left out: {}\n", mode_name(mode), error.what());
    }
  }
  return rows;
}

} // namespace

void run_bench(const Options &options) {
  const Setup setup = load_for_command(options);
  const Camera camera(options.device);
  const std::vector<Row> rows = bench_modes(setup, camera, options);
  if (options.json)
    print(report_json(setup, camera, rows));
  else
    print(report_text(setup, camera, rows));
}

} // namespace pmdsim
