#include "engine/correction/correction.h"
#include "engine/model/error.h"
#include "engine/reference/reference.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/correction/error_table.h"
#include "host/correction/measured_file.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// What an image is corrected for.
struct Scenery {
  Instant instant;
  std::size_t sensor;

  const Sensor &camera() const { return instant.sensors[sensor]; }
};

Scenery scenery_of(const Setup &setup, const CorrectOptions &options) {
  if (options.frame >= setup.frames.count)
    throw Error(ExitCode::usage, fmt::format("--frame {}: expected less than {}, the frames of {}",
                                             options.frame, setup.frames.count, setup.file.string()));
  Scenery scenery{setup.at(setup.frames.time_s(options.frame)), 0};
  const std::vector<Sensor> &sensors = scenery.instant.sensors;
  if (!options.sensor.empty()) {
    const auto named = std::ranges::find(sensors, options.sensor, &Sensor::name);
    if (named == sensors.end()) {
      std::vector<std::string> names;
      std::ranges::transform(sensors, std::back_inserter(names), &Sensor::name);
      throw Error(ExitCode::usage,
                  fmt::format("--sensor {}: expected one of {}", options.sensor, fmt::join(names, ", ")));
    }
    scenery.sensor = static_cast<std::size_t>(named - sensors.begin());
  }
  if (const std::size_t count = scenery.camera().modulation_hz.size(); options.image.frequency >= count)
    throw Error(ExitCode::usage,
                fmt::format("--frequency {}: expected less than {}, the frequencies of sensor {}",
                            options.image.frequency, count, scenery.camera().name));
  return scenery;
}

// What the image holds beyond the direct light of the setup's diodes, which is not taken off.
std::vector<std::string> not_corrected(const Setup &setup, const Scenery &scenery) {
  std::vector<std::string> effects;
  if (setup.bounces.any())
    effects.emplace_back("light that bounces between surfaces");
  if (!scenery.camera().scatter.empty())
    effects.emplace_back("scatter inside the camera");
  if (!scenery.instant.others.empty())
    effects.emplace_back("other cameras' light");
  if (scenery.camera().tap_interval_s > 0.0)
    effects.emplace_back("motion between the taps");
  if (setup.shadows != Shadows::off)
    effects.emplace_back("shadows, where some of the diodes do not reach a point");
  return effects;
}

// Ranges along the rays through the pixels' centres, by the reference.
TruthFile truth_of(const Scenery &scenery, const std::function<void(double)> &progress) {
  Sensor sensor = scenery.camera();
  sensor.samples = 1;
  sensor.electronics.reset();
  const reference::Frame frame =
      reference::simulate(scenery.instant.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                          Backscatter::constant, {}, progress);
  return {frame.range_m};
}

// The channels of what is written, and their values.
struct CorrectedChannels {
  std::vector<float> range_m, x_m, y_m, z_m, correction_mm, normal_error_mm;
  std::vector<std::uint32_t> status;
  std::vector<glm::vec3> normals; // world frame
  ChannelSet set;

  CorrectedChannels(const CorrectedImage &corrected, const Sensor &sensor) : status(corrected.status) {
    for (std::size_t pixel = 0; pixel < status.size(); ++pixel) {
      const glm::dvec3 point_m = corrected.range_m[pixel] * corrected.ray[pixel];
      range_m.push_back(static_cast<float>(corrected.range_m[pixel]));
      x_m.push_back(static_cast<float>(point_m.x));
      y_m.push_back(static_cast<float>(point_m.y));
      z_m.push_back(static_cast<float>(point_m.z));
      correction_mm.push_back(static_cast<float>(1e3 * corrected.correction_m[pixel]));
      normal_error_mm.push_back(static_cast<float>(1e3 * corrected.normal_error_m[pixel]));
      normals.emplace_back(sensor.world_from_camera.direction(corrected.normal[pixel]));
    }
    using Scale = ColourScale;
    set = {sensor.resolution,
           {{"range_m",
             "m",
             std::span<const float>(range_m),
             {},
             Preview{"range", Scale::sequential},
             "distance to the lens"},
            {"x_m", "m", std::span<const float>(x_m), {}, {}, "the point in the camera frame, to the right"},
            {"y_m", "m", std::span<const float>(y_m), {}, {}, "the same, down"},
            {"z_m", "m", std::span<const float>(z_m), {}, {}, "the same, along the optical axis"},
            {"correction_mm",
             "mm",
             std::span<const float>(correction_mm),
             {},
             Preview{"correction", Scale::sequential},
             "measured distance minus range"},
            {"normal_error_mm",
             "mm",
             std::span<const float>(normal_error_mm),
             {},
             {},
             "how far the range may be off by the surface's normal, estimated"},
            {"status",
             "",
             std::span<const std::uint32_t>(status),
             {},
             {},
             "0 corrected, 1 corrected at an edge, 2 not measured, 3 no light, 4 not converged"}}};
  }
};

std::vector<std::string> write(const CorrectedImage &corrected, const Scenery &scenery, const Setup &setup,
                               const Options &options, OutputSet &files) {
  const auto channels = std::make_shared<const CorrectedChannels>(corrected, scenery.camera());
  const std::uint32_t frame = options.correct.frame;
  const auto to_write = std::make_shared<const FrameToWrite>(FrameToWrite{
      scenery.camera(), frame, setup.frames.time_s(frame), channels->set, channels, channels->normals});
  files.add(write_files(files.directory(), files_of(to_write, options.capture.formats)));
  throw_if_interrupted();
  files.publish();
  return files.paths();
}

// Of one command.
struct Outcome {
  const MeasuredFile &measured;
  const Scenery &scenery;
  const CorrectOptions &options;
  CorrectedImage corrected;
  std::string truth; // what it is compared with; empty: nothing
  std::vector<ErrorRow> errors{};
  std::vector<std::string> effects{}, outputs{};

  std::size_t count(PixelStatus status) const { return corrected.counts[static_cast<std::size_t>(status)]; }
  Spread correction_mm() const {
    std::vector<double> values = corrected.correction_m;
    for (double &value : values)
      value *= 1e3;
    return spread_of(values);
  }
};

ordered_json json_of(const Outcome &of) {
  const Spread correction = of.correction_mm();
  const CorrectedImage &corrected = of.corrected;
  ordered_json json{
      {"image", of.measured.source},
      {"sensor", of.scenery.camera().name},
      {"modulation_hz", of.scenery.camera().modulation_hz[of.options.image.frequency]},
      {"pixels",
       {{"corrected", of.count(PixelStatus::corrected)},
        {"edge", of.count(PixelStatus::edge)},
        {"not_measured", of.count(PixelStatus::not_measured)},
        {"no_light", of.count(PixelStatus::no_light)},
        {"not_converged", of.count(PixelStatus::not_converged)}}},
      {"correction_mm", {{"min", correction.min}, {"median", correction.median}, {"max", correction.max}}},
      {"noise_um", 1e6 * corrected.noise_m},
      {"edge_limit_um", 1e6 * corrected.edge_limit_m},
      {"fit_pixels", corrected.fit_pixels},
      {"passes", corrected.passes},
      {"not_taken_off", of.effects},
      {"camera", camera_json(of.scenery.camera())}};
  if (!of.truth.empty()) {
    json["truth"] = of.truth;
    json["errors"] = error_json(of.errors);
  }
  json["outputs"] = of.outputs;
  return json;
}

std::string pixels_text(const Outcome &of) {
  const std::size_t pixels = of.corrected.status.size();
  const std::size_t corrected = of.count(PixelStatus::corrected) + of.count(PixelStatus::edge);
  const auto share = [&](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(pixels);
  };
  std::string text = fmt::format("corrected  {} of {} pixels", corrected, pixels);
  if (const std::size_t edges = of.count(PixelStatus::edge))
    text += fmt::format(
        ", of these {} ({:.1f} %) at edges, where an uncertain normal may move them by more than {}", edges,
        share(edges), micrometres_text(of.corrected.edge_limit_m));
  const std::array reasons{std::pair(PixelStatus::not_measured, "holds no number there"),
                           std::pair(PixelStatus::no_light, "no diode reaches the ray"),
                           std::pair(PixelStatus::not_converged, "no range found")};
  for (const auto &[status, reason] : reasons)
    if (of.count(status) > 0)
      text += fmt::format("\n           {} not: {}", of.count(status), reason);
  return text + '\n';
}

std::string text_of(const Outcome &of) {
  const Sensor &sensor = of.scenery.camera();
  std::string text = fmt::format("image      {}\nsensor     {}, {} x {} pixels, {}, {} diodes\n",
                                 of.measured.source, sensor.name, sensor.resolution.x, sensor.resolution.y,
                                 frequency_text(sensor.modulation_hz[of.options.image.frequency]),
                                 diode_count(of.scenery.instant.illuminators));
  text += of.measured.turns.empty()
              ? fmt::format("turns      ranges from {:g} m to {:.4g} m\n", of.options.least_range_m,
                            of.options.least_range_m + sensor.ambiguity_m(of.options.image.frequency))
              : fmt::format("turns      by {}\n", of.measured.turns);
  text += pixels_text(of);
  const Spread correction = of.correction_mm();
  text += fmt::format("correction {} mm to {} mm, median {} mm\n", table_number(correction.min),
                      table_number(correction.max), table_number(correction.median));
  if (of.options.normals == NormalsFrom::neighbours)
    text += fmt::format("normals    of planes fitted to {0} x {0} pixels; noise of ranges {1}\n",
                        2 * of.corrected.fit_pixels + 1, micrometres_text(of.corrected.noise_m));
  if (!of.effects.empty())
    text += fmt::format("not taken off: {}\n", fmt::join(of.effects, "; "));
  if (!of.truth.empty())
    text += fmt::format("\nerror against {}, um\n{}", of.truth, error_text(of.errors));
  return text + fmt::format("\nwritten:\n  {}\n", fmt::join(of.outputs, "\n  "));
}

} // namespace

void run_correct(const Options &options) {
  CorrectOptions wanted = options.correct;
  const Setup setup = requested_setup(options.capture);
  require_names_for_files(setup.start.sensors);
  const Scenery scenery = scenery_of(setup, wanted);
  const MeasuredFile measured = read_measured(wanted.image, scenery.camera(), wanted.frame);
  std::vector<double> true_range_m = measured.range_m, lit = measured.lit;
  std::string truth = true_range_m.empty() ? "" : "range_m of the same file";
  // Ranges that are means over several samples of a pixel are none of its centre.
  if (wanted.truth.empty() && !true_range_m.empty() && scenery.camera().samples > 1)
    wanted.truth = truth_of_scene;
  OutputSet files(options.capture.output_directory); // first, so that nothing is computed in vain
  ProgressBar bar(wanted.truth == truth_of_scene ? 2.0 : 1.0);
  if (!wanted.truth.empty()) {
    bar.begin("truth", 1.0);
    TruthFile of_truth = wanted.truth == truth_of_scene ? truth_of(scenery, interruptible_progress(bar))
                                                        : read_truth(wanted.truth, scenery.camera());
    true_range_m = std::move(of_truth.range_m);
    lit = of_truth.lit.empty() ? lit : std::move(of_truth.lit);
    truth = wanted.truth == truth_of_scene ? "the scene, at the pixels' centres" : wanted.truth;
  }
  bar.begin("correction", 1.0);
  const CorrectionOptions how{.frequency = wanted.image.frequency,
                              .backscatter = setup.backscatter,
                              .least_range_m = wanted.least_range_m,
                              .normals = wanted.normals,
                              .fit_pixels = wanted.fit_pixels};
  Outcome outcome{measured, scenery, wanted,
                  correct(scenery.camera(), scenery.instant.illuminators, measured.image, how,
                          interruptible_progress(bar)),
                  truth};
  outcome.effects = not_corrected(setup, scenery);
  if (!truth.empty())
    outcome.errors = error_rows(outcome.corrected, true_range_m, lit);
  outcome.outputs = write(outcome.corrected, scenery, setup, options, files);
  print(options.json ? json_text(json_of(outcome)) : text_of(outcome));
}

} // namespace pmdsim
