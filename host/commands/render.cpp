#include "host/commands/camera.h"
#include "host/commands/commands.h"
#include "host/commands/frame_writer.h"
#include "host/commands/interruption.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"
#include "host/output/manifest.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json report_json(const RunRecord &run, const OutputSet &outputs) {
  const FrameRecord &frame = run.frames.front();
  return {{"device", run.device},
          {"mode", run.mode},
          {"frames",
           {{{"sensor", frame.sensor.name},
             {"frame", frame.frame},
             {"frame_ms", frame.frame_ms},
             {"passes_ms", passes_json(frame.passes)},
             {"error_claimed_m", nullptr},
             {"error_found_m", nullptr},
             {"outputs", outputs.paths()}}}}};
}

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
  return fmt::format("{:<10}{:>12}{:>12}{:>12}  {}\n", quantity, table_number(min), table_number(median),
                     table_number(max), unit);
}

std::string report_text(const RunRecord &run, const Measurement &measurement, const OutputSet &outputs) {
  std::string text =
      fmt::format("device    {} ({})\nframe     {:.3f} ms\n\n", run.device, run.driver, measurement.frame_ms);
  text += fmt::format("{:<10}{:>12}{:>12}{:>12}\n", "", "min", "median", "max");
  text += spread_line("distance", measurement.returns[0].distance_m, "m");
  text += spread_line("amplitude", measurement.returns[0].amplitude, "W/(m² sr)");
  text += fmt::format("\n{:.2f} % of the samples hit the scene\n\nwritten:\n",
                      100.0 * mean_coverage(measurement.coverage));
  for (const std::string &path : outputs.paths())
    text += fmt::format("  {}\n", path);
  return text;
}

} // namespace

void run_render(const Options &options) {
  const Setup setup = load_for_command(options);
  const Sensor &sensor = setup.sensors.front();
  require_name_for_files(sensor);
  OutputSet outputs(options.output_directory);

  Camera camera(options.device);
  camera.prepare(setup.scene, sensor, setup.illuminators.front(), setup.backscatter);
  const Measurement measurement = camera.measure("measuring");

  write_frame(outputs, {sensor, 0, channels_of(measurement), {"amplitude", "phase_rad", "distance_m"}},
              options.formats);
  const RunRecord run{
      "render", camera.device(), camera.driver(),
      "exact",  setup.as_used,   {{sensor, 0, measurement.frame_ms, measurement.passes, outputs.names()}}};
  outputs.add("manifest.json", [&](OutputFile &file) { file.write(json_text(manifest_json(run))); });
  throw_if_interrupted();
  outputs.publish();

  if (options.json)
    print(report_json(run, outputs));
  else
    print(report_text(run, measurement, outputs));
}

} // namespace pmdsim
