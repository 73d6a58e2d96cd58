#include "host/commands/camera.h"
#include "host/commands/commands.h"
#include "host/commands/frame_writer.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"
#include "host/output/manifest.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>

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

std::string frame_text(const Sensor &sensor, const Measurement &measurement) {
  std::string text = fmt::format("{}, frame 0, {:.3f} ms\n", sensor.name, measurement.frame_ms);
  text += fmt::format("{:<24}{:>12}{:>12}{:>12}\n", "", "min", "median", "max");
  for (std::size_t i = 0; i < measurement.returns.size(); ++i) {
    const std::string at = frequency_of(i, sensor.modulation_hz.size())
                               ? " at " + frequency_text(sensor.modulation_hz[i])
                               : std::string();
    text += spread_line("distance" + at, measurement.returns[i].distance_m, "m");
    text += spread_line("amplitude" + at, measurement.returns[i].amplitude, "W/(m² sr)");
  }
  return text + fmt::format("{:.2f} % of the samples hit the scene\n\n",
                            100.0 * mean_coverage(measurement.coverage));
}

struct RenderedFrame {
  FrameRecord record;
  std::string text;
};

// The measurement lives no longer than its files need it: frames of several large sensors would not fit side
// by side.
RenderedFrame render_frame(Camera &camera, const Setup &setup, const Sensor &sensor, OutputSet &outputs,
                           const std::set<Format> &formats) {
  camera.prepare(setup.start.scene, sensor, setup.start.illuminators, setup.backscatter);
  const Measurement measurement = camera.measure("measuring " + sensor.name);
  const std::size_t first_output = outputs.names().size();
  write_frame(outputs, {sensor, 0, channels_of(measurement), {"amplitude", "phase_rad", "distance_m"}},
              formats);
  return {{sensor, 0, measurement.frame_ms, measurement.passes, outputs.names_from(first_output)},
          frame_text(sensor, measurement)};
}

// Beside its own files a frame names the manifest, which says how to read them.
ordered_json frame_json(const FrameRecord &frame, const OutputSet &outputs) {
  ordered_json paths = ordered_json::array();
  for (const std::string &name : frame.outputs)
    paths.push_back(outputs.path_of(name));
  paths.push_back(outputs.path_of(manifest_name));
  return {{"sensor", frame.sensor.name},
          {"frame", frame.frame},
          {"frame_ms", frame.frame_ms},
          {"passes_ms", passes_json(frame.passes)},
          {"error_claimed_m", nullptr},
          {"error_found_m", nullptr},
          {"outputs", paths}};
}

ordered_json report_json(const RunRecord &run, const OutputSet &outputs) {
  ordered_json frames = ordered_json::array();
  for (const FrameRecord &frame : run.frames)
    frames.push_back(frame_json(frame, outputs));
  return {{"device", run.device}, {"mode", run.mode}, {"frames", frames}};
}

} // namespace

void run_render(const Options &options) {
  const Setup setup = load_for_command(options);
  require_names_for_files(setup.start.sensors);
  OutputSet outputs(options.output_directory);
  Camera camera(options.device, {.taps = true});
  RunRecord run{"render", camera.device(), camera.driver(), "exact", setup.as_used, {}};
  std::string text = fmt::format("device    {} ({})\n\n", camera.device(), camera.driver());
  for (const Sensor &sensor : setup.start.sensors) {
    const RenderedFrame frame = render_frame(camera, setup, sensor, outputs, options.formats);
    run.frames.push_back(frame.record);
    text += frame.text;
  }
  publish_run(outputs, run);
  if (options.json)
    print(report_json(run, outputs));
  else
    print(text + written_text(outputs.paths()));
}

} // namespace pmdsim
