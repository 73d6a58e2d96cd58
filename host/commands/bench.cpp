#include "host/commands/accuracy_check.h"
#include "host/commands/commands.h"
#include "host/commands/exposure.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/progress_bar.h"
#include "host/commands/report.h"
#include "host/output/manifest.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <map>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr int measured_frames = 7;

// Of one sensor's frame or, summed, of all sensors' frames.
struct Timing {
  Spread frame_ms{0.0, 0.0, 0.0};
  std::vector<PassTime> passes; // medians, in the order of the frame
};

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

// Nothing where the camera is the reference itself.
std::vector<AccuracyCheck> check_before_timing(const Setup &setup, const Camera &camera,
                                               const std::string &device) {
  if (camera.is_reference())
    return {};
  std::vector<AccuracyCheck> checks = check_accuracy(setup, device);
  for (const AccuracyCheck &check : checks)
    require_plausible(check, camera.device());
  return checks;
}

// Of all sensors and exposures.
double interaction_count(const Setup &setup) {
  return samples_of_frame(setup) * static_cast<double>(diode_count(setup.start.illuminators));
}

// Only times are kept: frames of the largest sensors would not fit side by side.
Timing time_frames(const Setup &setup, std::size_t sensor, Exposures &exposures, ProgressBar &bar) {
  const auto measure = [&](const std::string &label) {
    bar.begin(label, samples_of_frame(setup, setup.start.sensors[sensor]));
    return exposures.take(sensor, setup.frames.start_s, Light::beside_lens, interruptible_progress(bar))
        .measurement;
  };
  std::vector<double> frames_ms;
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> passes_ms;
  measure("warming up");
  for (int i = 0; i < measured_frames; ++i) {
    const Measurement measurement = measure(fmt::format("timing {}/{}", i + 1, measured_frames));
    frames_ms.push_back(measurement.frame_ms);
    for (const PassTime &pass : measurement.passes) {
      if (!passes_ms.contains(pass.name))
        order.push_back(pass.name);
      passes_ms[pass.name].push_back(pass.ms);
    }
  }
  Timing timing{spread_of(frames_ms), {}};
  for (const std::string &name : order)
    timing.passes.push_back({name, spread_of(passes_ms[name]).median});
  return timing;
}

void add(Timing &sum, const Timing &timing) {
  sum.frame_ms.min += timing.frame_ms.min;
  sum.frame_ms.median += timing.frame_ms.median;
  sum.frame_ms.max += timing.frame_ms.max;
  for (const PassTime &pass : timing.passes) {
    const auto known = std::ranges::find(sum.passes, pass.name, &PassTime::name);
    if (known == sum.passes.end())
      sum.passes.push_back(pass);
    else
      known->ms += pass.ms;
  }
}

Timing time_all_sensors(const Setup &setup, Exposures &exposures) {
  ProgressBar bar((1 + measured_frames) * samples_of_frame(setup));
  Timing sum;
  for (std::size_t i = 0; i < setup.start.sensors.size(); ++i)
    add(sum, time_frames(setup, i, exposures, bar));
  return sum;
}

// NaN where there is no pass named "accumulate".
double interactions_per_s(const Setup &setup, const Timing &timing) {
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

ordered_json report_json(const Setup &setup, const Camera &camera, const Timing &timing,
                         const std::vector<AccuracyCheck> &checks) {
  const ordered_json result{{"name", "setup"},
                            {"mode", "exact"},
                            {"frame_ms", timing.frame_ms.median},
                            {"frame_ms_min", timing.frame_ms.min},
                            {"frame_ms_max", timing.frame_ms.max},
                            {"frames_per_s", frames_per_s(timing)},
                            {"interactions_per_s", interactions_per_s(setup, timing)},
                            {"passes_ms", passes_json(timing.passes)},
                            {"error_found_m", largest_error_m(checks)}};
  return {{"device", camera.device()},
          {"driver", camera.driver()},
          {"processor", processor_name()},
          {"results", ordered_json::array({result})},
          {"ratios", ordered_json::object()}};
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

std::string report_text(const Setup &setup, const Camera &camera, const Timing &timing,
                        const std::vector<AccuracyCheck> &checks) {
  std::string text =
      fmt::format("device     {} ({})\nprocessor  {}\n", camera.device(), camera.driver(), processor_name());
  for (const AccuracyCheck &check : checks)
    text += fmt::format("error      {}\n", error_text(check));
  const std::string sensors =
      setup.start.sensors.size() > 1 ? fmt::format(" of each of {} sensors", setup.start.sensors.size()) : "";
  text += fmt::format("frame      {:.3f} ms ({:.3f} to {:.3f} in {} warm frames{}), {:.4g} frames/s\n",
                      timing.frame_ms.median, timing.frame_ms.min, timing.frame_ms.max, measured_frames,
                      sensors, frames_per_s(timing));
  for (const PassTime &pass : timing.passes)
    text += fmt::format("  {:<20}{:>10.3f} ms\n", pass.name, pass.ms);
  if (const double rate = interactions_per_s(setup, timing); !std::isnan(rate))
    text += fmt::format("rate       {:.4g} interactions/s in the accumulate pass\n", rate);
  return text;
}

} // namespace

void run_bench(const Options &options) {
  const Setup setup = load_for_command(options);
  Exposures exposures(setup, options.device, false);
  const Camera &camera = exposures.camera();
  const std::vector<AccuracyCheck> checks = check_before_timing(setup, camera, options.device);
  const Timing timing = time_all_sensors(setup, exposures);
  if (options.json)
    print(report_json(setup, camera, timing, checks));
  else
    print(report_text(setup, camera, timing, checks));
}

} // namespace pmdsim
