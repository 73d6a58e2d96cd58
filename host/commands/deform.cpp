#include "host/commands/camera.h"
#include "host/commands/commands.h"
#include "host/commands/frame_writer.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"
#include "host/output/deformation.h"
#include "host/output/manifest.h"
#include "host/output/profile.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// Deformations of one frame, a map each frequency.
using Maps = std::vector<std::vector<float>>;

struct DeformedFrame {
  FrameRecord record;
  std::vector<DeformationStatistics> statistics; // of each frequency
};

// Only the distances are kept while the frame with the light beside the lens is measured.
Maps monostatic_distances_m(Camera &camera, const Setup &setup, const Sensor &sensor) {
  camera.prepare(setup.start.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                 setup.backscatter);
  Measurement measurement = camera.measure(fmt::format("measuring {}, light in the lens", sensor.name));
  Maps distances_m;
  for (Return &of_frequency : measurement.returns)
    distances_m.push_back(std::move(of_frequency.distance_m));
  return distances_m;
}

void write_profile_plot(OutputSet &outputs, const FrameToWrite &frame, const Channel &deformation) {
  const glm::uvec2 &resolution = frame.channels.resolution;
  const std::string quantity = fmt::format("deformation along row {}", profile_row(resolution));
  const std::string title = picture_title(quantity, frame, deformation.frequency);
  const std::string stem = frame_file_stem(frame.sensor, frame.frame);
  const std::string name = channel_name("deformation_profile", deformation.frequency);
  outputs.add(fmt::format("{}.{}.png", stem, name), [&](OutputFile &file) {
    draw_profile(std::get<std::span<const float>>(deformation.values), resolution, "deformation", "mm", title)
        .write_png(file);
  });
}

void write_files(OutputSet &outputs, const Sensor &sensor, const Measurement &bistatic,
                 const Maps &deformations, const std::set<Format> &formats) {
  ChannelSet set{bistatic.resolution, {}};
  for (std::size_t i = 0; i < deformations.size(); ++i)
    set.channels.push_back(
        {"deformation_mm", "mm", std::span(deformations[i]), frequency_of(i, deformations.size())});
  const ChannelSet measured = channels_of(bistatic);
  set.channels.insert(set.channels.end(), measured.channels.begin(), measured.channels.end());
  const FrameToWrite frame{sensor, 0, set, {"deformation_mm"}};
  write_frame(outputs, frame, formats);
  if (formats.contains(Format::png))
    for (std::size_t i = 0; i < deformations.size(); ++i)
      write_profile_plot(outputs, frame, set.channels[i]);
}

DeformedFrame deform_frame(Camera &camera, const Setup &setup, const Sensor &sensor, OutputSet &outputs,
                           const std::set<Format> &formats) {
  const Maps monostatic_m = monostatic_distances_m(camera, setup, sensor);
  camera.prepare(setup.start.scene, sensor, setup.start.illuminators, setup.backscatter);
  const Measurement bistatic =
      camera.measure(fmt::format("measuring {}, light beside the lens", sensor.name));
  Maps deformations;
  std::vector<DeformationStatistics> statistics;
  for (std::size_t i = 0; i < bistatic.returns.size(); ++i) {
    deformations.push_back(
        deformation_mm(bistatic.returns[i].distance_m, monostatic_m[i], sensor.ambiguity_m(i)));
    statistics.push_back(statistics_of(deformations.back(), bistatic.resolution));
  }
  const std::size_t first_output = outputs.names().size();
  write_files(outputs, sensor, bistatic, deformations, formats);
  return {{sensor, 0, bistatic.frame_ms, bistatic.passes, outputs.names_from(first_output)}, statistics};
}

ordered_json statistics_json(const DeformationStatistics &statistics) {
  return {{"mean", statistics.mean_mm},
          {"min", statistics.min_mm},
          {"max", statistics.max_mm},
          {"centre", statistics.centre_mm},
          {"rms", statistics.rms_mm}};
}

ordered_json report_json(const std::vector<DeformedFrame> &frames, const OutputSet &outputs) {
  ordered_json list = ordered_json::array();
  for (const DeformedFrame &frame : frames) {
    ordered_json deformations = ordered_json::array();
    for (const DeformationStatistics &statistics : frame.statistics)
      deformations.push_back(statistics_json(statistics));
    list.push_back({{"sensor", frame.record.sensor.name},
                    {"frame", frame.record.frame},
                    {"modulation_hz", frame.record.sensor.modulation_hz},
                    {"deformation_mm", deformations}});
  }
  return {{"deformation_mm", statistics_json(frames.front().statistics.front())},
          {"frames", list},
          {"outputs", outputs.paths()}};
}

// One row a sensor and frequency.
std::string table_text(const std::vector<DeformedFrame> &frames) {
  std::size_t width = 0;
  std::vector<std::pair<std::string, DeformationStatistics>> rows;
  for (const auto &[record, statistics] : frames)
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      const std::string frequency = frequency_text(record.sensor.modulation_hz[i]);
      rows.emplace_back(fmt::format("{}, {}", record.sensor.name, frequency), statistics[i]);
      width = std::max(width, rows.back().first.size());
    }
  std::string text =
      fmt::format("{:<{}}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "", width, "mean", "min", "max", "centre", "rms");
  for (const auto &[label, statistics] : rows) {
    text += fmt::format("{:<{}}", label, width);
    for (const double value_mm :
         {statistics.mean_mm, statistics.min_mm, statistics.max_mm, statistics.centre_mm, statistics.rms_mm})
      text += fmt::format("{:>12}", table_number(value_mm));
    text += '\n';
  }
  return text;
}

} // namespace

void run_deform(const Options &options) {
  const Setup setup = load_for_command(options);
  require_names_for_files(setup.start.sensors);
  OutputSet outputs(options.output_directory);
  Camera camera(options.device);
  RunRecord run{"deform", camera.device(), camera.driver(), "exact", setup.as_used, {}};
  std::vector<DeformedFrame> frames;
  for (const Sensor &sensor : setup.start.sensors) {
    frames.push_back(deform_frame(camera, setup, sensor, outputs, options.formats));
    run.frames.push_back(frames.back().record);
  }
  publish_run(outputs, run);
  if (options.json)
    print(report_json(frames, outputs));
  else
    print(fmt::format("device    {} ({})\n\ndeformation (bistatic - monostatic distance), mm\n{}\n{}",
                      camera.device(), camera.driver(), table_text(frames), written_text(outputs.paths())));
}

} // namespace pmdsim
