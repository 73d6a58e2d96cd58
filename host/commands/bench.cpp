#include "host/commands/accuracy_check.h"
#include "host/commands/camera.h"
#include "host/commands/commands.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"
#include "host/output/manifest.h"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr int measured_frames = 7;

struct Timing {
  Spread frame_ms;
  std::vector<PassTime> passes; // medians, in the order of the frame
  double interactions_per_s;    // NaN where there is no pass named "accumulate"
};

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

std::optional<AccuracyCheck> check_before_timing(const Setup &setup, const Camera &camera,
                                                 const std::string &device) {
  if (camera.is_reference())
    return std::nullopt;
  const AccuracyCheck check = check_accuracy(setup, device);
  require_plausible(check, setup.sensors.front(), camera.device());
  return check;
}

double interaction_count(const Setup &setup) {
  const Sensor &sensor = setup.sensors.front();
  return static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples *
         static_cast<double>(setup.illuminators.front().diodes.size());
}

// Only times are kept: frames of the largest sensors would not fit side by side.
Timing time_frames(Camera &camera, double interactions) {
  std::vector<double> frames_ms;
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> passes_ms;
  camera.measure("warming up");
  for (int i = 0; i < measured_frames; ++i) {
    const Measurement measurement = camera.measure(fmt::format("timing {}/{}", i + 1, measured_frames));
    frames_ms.push_back(measurement.frame_ms);
    for (const PassTime &pass : measurement.passes) {
      if (!passes_ms.contains(pass.name))
        order.push_back(pass.name);
      passes_ms[pass.name].push_back(pass.ms);
    }
  }
  Timing timing{spread_of(frames_ms), {}, std::numeric_limits<double>::quiet_NaN()};
  for (const std::string &name : order)
    timing.passes.push_back({name, spread_of(passes_ms[name]).median});
  if (passes_ms.contains("accumulate"))
    timing.interactions_per_s = interactions / (1e-3 * spread_of(passes_ms["accumulate"]).median);
  return timing;
}

double frames_per_s(const Timing &timing) { return 1e3 / timing.frame_ms.median; }

ordered_json error_json(const std::optional<AccuracyCheck> &check) {
  return check ? ordered_json(check->distance_max_m) : ordered_json(nullptr);
}

ordered_json report_json(const Camera &camera, const Timing &timing,
                         const std::optional<AccuracyCheck> &check) {
  const ordered_json result{{"name", "setup"},
                            {"mode", "exact"},
                            {"frame_ms", timing.frame_ms.median},
                            {"frame_ms_min", timing.frame_ms.min},
                            {"frame_ms_max", timing.frame_ms.max},
                            {"frames_per_s", frames_per_s(timing)},
                            {"interactions_per_s", timing.interactions_per_s},
                            {"passes_ms", passes_json(timing.passes)},
                            {"error_found_m", error_json(check)}};
  return {{"device", camera.device()},
          {"driver", camera.driver()},
          {"processor", processor_name()},
          {"results", ordered_json::array({result})},
          {"ratios", ordered_json::object()}};
}

std::string error_text(const AccuracyCheck &check) {
  if (check.comparable == 0)
    return "nothing to compare: the reference is dark in every pixel";
  return fmt::format("at most {:.4g} µm over {} pixels of {} x {}, against the reference",
                     1e6 * check.distance_max_m, check.pixels, check.resolution.x, check.resolution.y);
}

std::string report_text(const Camera &camera, const Timing &timing,
                        const std::optional<AccuracyCheck> &check) {
  std::string text =
      fmt::format("device     {} ({})\nprocessor  {}\n", camera.device(), camera.driver(), processor_name());
  if (check)
    text += fmt::format("error      {}\n", error_text(*check));
  text += fmt::format("frame      {:.3f} ms ({:.3f} to {:.3f} in {} warm frames), {:.4g} frames/s\n",
                      timing.frame_ms.median, timing.frame_ms.min, timing.frame_ms.max, measured_frames,
                      frames_per_s(timing));
  for (const PassTime &pass : timing.passes)
    text += fmt::format("  {:<20}{:>10.3f} ms\n", pass.name, pass.ms);
  if (!std::isnan(timing.interactions_per_s))
    text +=
        fmt::format("rate       {:.4g} interactions/s in the accumulate pass\n", timing.interactions_per_s);
  return text;
}

} // namespace

void run_bench(const Options &options) {
  const Setup setup = load_for_command(options);
  Camera camera(options.device);
  const std::optional<AccuracyCheck> check = check_before_timing(setup, camera, options.device);
  camera.prepare(setup.scene, setup.sensors.front(), setup.illuminators.front(), setup.backscatter);
  const Timing timing = time_frames(camera, interaction_count(setup));
  if (options.json)
    print(report_json(camera, timing, check));
  else
    print(report_text(camera, timing, check));
}

} // namespace pmdsim
