#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// NaN counts as nothing hit.
double mean_coverage(const std::vector<float> &coverage) {
  const auto add = [](double sum, float share) {
    return std::isnan(share) ? sum : sum + static_cast<double>(share);
  };
  return std::accumulate(coverage.begin(), coverage.end(), 0.0, add) / static_cast<double>(coverage.size());
}

std::string spread_line(const std::string &quantity, const std::vector<float> &values,
                        const std::string &unit) {
  const auto [min, median, max] = spread_of(values);
  return fmt::format("{:<24}{:>12}{:>12}{:>12}  {}\n", quantity, table_number(min), table_number(median),
                     table_number(max), unit);
}

std::string frame_text(const TakenFrame &taken, std::uint32_t frame) {
  const auto &[sensor, measurement, mode] = taken;
  std::string text = fmt::format("{}, frame {}, {:.3f} ms\n", sensor.name, frame, measurement.frame_ms);
  text += fmt::format("{:<24}{:>12}{:>12}{:>12}\n", "", "min", "median", "max");
  for (std::size_t i = 0; i < measurement.returns.size(); ++i) {
    const std::string at = frequency_of(i, sensor.modulation_hz.size())
                               ? " at " + frequency_text(sensor.modulation_hz[i])
                               : std::string();
    text += spread_line("distance" + at, measurement.returns[i].distance_m, "m");
    text += spread_line("amplitude" + at, measurement.returns[i].amplitude, "W/(m² sr)");
    if (!measurement.returns[i].multipath_m.empty())
      text += spread_line("multipath" + at, measurement.returns[i].multipath_m, "m");
  }
  text += fmt::format("{:.2f} % of the samples hit the scene\n", 100.0 * mean_coverage(measurement.coverage));
  if (measurement.bounces)
    text += bounces_text(*measurement.bounces) + "\n";
  return text + accuracy_text(mode, measurement.accuracy) + "\n";
}

// Beside its own files a frame names the manifest, which says how to read them.
ordered_json frame_told(const ordered_json &of_sensor, const FrameSequence &sequence) {
  ordered_json json = told_json(of_sensor);
  json["outputs"] = array_of(of_sensor.at("manifest").at("outputs"),
                             [&](const std::string &name) { return sequence.path_of(name); });
  json["outputs"].push_back(sequence.path_of(manifest_name));
  return json;
}

void print_render_json(const Capture &capture) {
  const RunHead &run = capture.sequence().run();
  JsonPieces pieces([](std::string_view text) { print(std::string(text)); },
                    {{"device", run.device}, {"mode", mode_name(run.accuracy.mode)}});
  pieces.list("frames", [&](const JsonPieces::Add &add) {
    capture.for_each_sensor_frame(
        [&](const ordered_json &of_sensor) { add(frame_told(of_sensor, capture.sequence())); });
  });
  pieces.end();
}

// Writes all frames and returns what is to be said of the first that is made here.
std::string render(Capture &capture) {
  std::string text;
  std::optional<std::uint32_t> first;
  const auto measure = [&](const SensorFrame &at) {
    const auto taken = capture.share(capture.take(at, Light::beside_lens, at.next_s));
    if (at.frame == first.value_or(at.frame))
      text += frame_text(*taken, at.frame);
    first = first.value_or(at.frame);
    return rendered_frame(taken, at, capture.formats());
  };
  capture.write(measure, bytes_of_largest_frame(capture.setup(), true));
  return text;
}

} // namespace

void run_render(const Options &options) {
  Capture capture(options.capture, "render", true);
  const std::string text = render(capture);
  if (options.json)
    print_render_json(capture);
  else
    print(capture.device_text() + text + capture.sequence().written_text());
}

} // namespace pmdsim
