#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/commands/rendered.h"
#include "host/commands/report_of_run.h"
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

// Nothing of a channel that is not there.
std::string spread_line(const std::string &quantity, const std::vector<float> &values,
                        const std::string &unit) {
  if (values.empty())
    return {};
  const auto [min, median, max] = spread_of(values);
  return fmt::format("{:<24}{:>12}{:>12}{:>12}  {}\n", quantity, table_number(min), table_number(median),
                     table_number(max), unit);
}

std::string frame_text(const TakenFrame &taken, std::uint32_t frame) {
  const auto &[sensor, measurement, mode, normals, warnings] = taken;
  std::string text = fmt::format("{}, frame {}, {:.3f} ms\n", sensor.name, frame, measurement.frame_ms);
  const std::string head = fmt::format("{:<24}{:>12}{:>12}{:>12}\n", "", "min", "median", "max");
  std::string lines;
  for (std::size_t i = 0; i < measurement.returns.size(); ++i) {
    const std::string at = frequency_of(i, sensor.modulation_hz.size())
                               ? " at " + frequency_text(sensor.modulation_hz[i])
                               : std::string();
    lines += spread_line("distance" + at, measurement.returns[i].distance_m, "m");
    lines += spread_line("amplitude" + at, measurement.returns[i].amplitude, "W/(m² sr)");
    lines += spread_line("multipath" + at, measurement.returns[i].multipath_m, "m");
  }
  if (!lines.empty())
    text += head + lines;
  if (!measurement.coverage.empty())
    text +=
        fmt::format("{:.2f} % of the samples hit the scene\n", 100.0 * mean_coverage(measurement.coverage));
  if (measurement.bounces)
    text += bounces_text(*measurement.bounces) + "\n";
  return text + accuracy_text(mode, measurement.accuracy) + "\n";
}

void print_render_json(const Capture &capture, const std::string &report) {
  const RunHead &run = capture.sequence().run();
  ordered_json head{{"device", run.device}, {"mode", mode_name(run.accuracy.mode)}};
  if (!report.empty())
    head["report"] = report;
  JsonPieces pieces([](std::string_view text) { print(std::string(text)); }, head);
  pieces.list("frames", [&](const JsonPieces::Add &add) {
    capture.for_each_sensor_frame(
        [&](const ordered_json &of_sensor) { add(frame_told(of_sensor, capture.sequence())); });
  });
  pieces.list("sheets", [&](const JsonPieces::Add &add) {
    for (const std::string &name : capture.sequence().sheets())
      add(capture.sequence().path_of(name));
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
    return rendered_frame(taken, at, capture.formats(), capture.setup().start.scene.objects);
  };
  capture.write(measure, bytes_of_rendered_frame(capture));
  return text;
}

} // namespace

ordered_json frame_told(const ordered_json &of_sensor, const FrameSequence &sequence) {
  ordered_json json = told_json(of_sensor);
  json["outputs"] = array_of(of_sensor.at("manifest").at("outputs"),
                             [&](const std::string &name) { return sequence.path_of(name); });
  json["outputs"].push_back(sequence.path_of(manifest_name));
  return json;
}

std::size_t bytes_of_rendered_frame(const Capture &capture) {
  return bytes_of_largest_frame(capture.setup(), true, capture.channels(), 0,
                                capture.output_precision() == OutputPrecision::float64);
}

void run_render(const Options &options) {
  if (!options.setups.empty())
    return run_variants(options);
  Capture capture(options.capture, "render", true);
  const std::string text = render(capture);
  const std::string report = report_of_run(options, capture);
  if (options.json)
    print_render_json(capture, report);
  else
    print(capture.device_text() + text + capture.sequence().written_text() + report_line(report));
}

} // namespace pmdsim
