#include "host/commands/camera.h"
#include "host/commands/commands.h"
#include "host/commands/frame_writer.h"
#include "host/commands/interruption.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"
#include "host/output/deformation.h"
#include "host/output/manifest.h"
#include "host/output/profile.h"

#include <fmt/format.h>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json statistics_json(const DeformationStatistics &statistics) {
  return {{"mean", statistics.mean_mm},
          {"min", statistics.min_mm},
          {"max", statistics.max_mm},
          {"centre", statistics.centre_mm},
          {"rms", statistics.rms_mm}};
}

std::string report_text(const Camera &camera, const DeformationStatistics &statistics,
                        const OutputSet &outputs) {
  std::string text = fmt::format("device    {} ({})\n\n", camera.device(), camera.driver());
  text += "deformation (bistatic - monostatic distance), mm\n";
  text += fmt::format("{:>12}{:>12}{:>12}{:>12}{:>12}\n", "mean", "min", "max", "centre", "rms");
  for (const double value_mm :
       {statistics.mean_mm, statistics.min_mm, statistics.max_mm, statistics.centre_mm, statistics.rms_mm})
    text += fmt::format("{:>12}", table_number(value_mm));
  text += "\n\nwritten:\n";
  for (const std::string &path : outputs.paths())
    text += fmt::format("  {}\n", path);
  return text;
}

void write_profile_plot(OutputSet &outputs, const Sensor &sensor, const std::vector<float> &deformation) {
  const std::string title =
      fmt::format("deformation along row {}, {}, frame 0", profile_row(sensor.resolution), sensor.name);
  outputs.add(frame_file_stem(sensor, 0) + ".deformation_profile.png", [&](OutputFile &file) {
    draw_profile(deformation, sensor.resolution, "deformation", "mm", title).write_png(file);
  });
}

} // namespace

void run_deform(const Options &options) {
  const Setup setup = load_for_command(options);
  const Sensor &sensor = setup.sensors.front();
  require_name_for_files(sensor);
  OutputSet outputs(options.output_directory);

  Camera camera(options.device);
  camera.prepare(setup.scene, sensor, monostatic_illuminator(sensor.world_from_camera), setup.backscatter);
  const std::vector<float> monostatic_distance_m =
      camera.measure("measuring, light in the lens").returns[0].distance_m;
  camera.prepare(setup.scene, sensor, setup.illuminators.front(), setup.backscatter);
  const Measurement bistatic = camera.measure("measuring, light beside the lens");
  const std::vector<float> deformation =
      deformation_mm(bistatic.returns[0].distance_m, monostatic_distance_m, sensor.ambiguity_m());
  const DeformationStatistics statistics = statistics_of(deformation, sensor.resolution);

  ChannelSet channels = channels_of(bistatic);
  channels.channels.insert(channels.channels.begin(),
                           {"deformation_mm", "mm", std::span<const float>(deformation)});
  write_frame(outputs, {sensor, 0, channels, {"deformation_mm"}}, options.formats);
  if (options.formats.contains(Format::png))
    write_profile_plot(outputs, sensor, deformation);
  const RunRecord run{"deform",        camera.device(),
                      camera.driver(), "exact",
                      setup.as_used,   {{sensor, 0, bistatic.frame_ms, bistatic.passes, outputs.names()}}};
  outputs.add("manifest.json", [&](OutputFile &file) { file.write(json_text(manifest_json(run))); });
  throw_if_interrupted();
  outputs.publish();

  if (options.json)
    print(ordered_json{{"deformation_mm", statistics_json(statistics)}, {"outputs", outputs.paths()}});
  else
    print(report_text(camera, statistics, outputs));
}

} // namespace pmdsim
