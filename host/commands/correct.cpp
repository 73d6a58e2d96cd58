#include "engine/correction/correction.h"
#include "engine/model/error.h"
#include "engine/reference/reference.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/commands/correct_channels.h"
#include "host/commands/correct_words.h"
#include "host/correction/error_table.h"
#include "host/correction/measured_file.h"
#include "host/input/file/files_read.h"
#include "host/input/file/input_file.h"
#include "host/memory/memory_limit.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/output/run/frame_records.h"
#include "host/output/run/run_json.h"
#include "host/report/report.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

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

constexpr std::uint64_t bytes_of_corrected_pixel = 300; // of all that is made of it, until it is written

// A run of another command is not to lose its manifest, nor its frames of the same names.
void refuse_other_run(const std::filesystem::path &directory) {
  const std::filesystem::path file = directory / manifest_name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    return;
  const auto manifest =
      parsed_in_order(read_regular_file(file, max_manifest_bytes, Place{file}), file, max_manifest_values);
  const ordered_json written =
      manifest && manifest->is_object() ? manifest->value("command", ordered_json()) : ordered_json();
  const std::string command = written.is_string() ? written.get<std::string>() : "";
  if (!command.empty() && command != "correct")
    throw Error(ExitCode::output, fmt::format("{}: has the frames of `pmdsim {}`, expected another directory",
                                              directory.string(), command));
}

// What a manifest and its frames say of how light was summed, which nothing was here.
constexpr std::array measuring_keys{"device",
                                    "driver",
                                    "mode",
                                    "max_error_m",
                                    "max_amplitude_error",
                                    "precision",
                                    "diodes",
                                    "error_claimed_m",
                                    "error_found_m",
                                    "amplitude_error_claimed",
                                    "amplitude_error_found",
                                    "unpromised",
                                    "checked_pixels"};

// manifest.json, as `report` reads it.
ordered_json manifest_of(const Outcome &outcome, const Setup &setup, const Options &options,
                         const std::vector<std::string> &outputs) {
  RunHead head = head_of(options.capture, setup, "correct");
  head.warnings.insert(head.warnings.end(), outcome.measured.warnings.begin(),
                       outcome.measured.warnings.end());
  ordered_json manifest = head_json(head);
  const std::uint32_t frame = outcome.options.frame;
  FrameRecord record;
  record.sensor = outcome.scenery.camera();
  record.frame = frame;
  record.time_s = setup.frames.time_s(frame);
  for (const std::string &path : outputs)
    record.outputs.push_back({std::filesystem::path(path).filename().string()});
  ordered_json told = json_of(outcome);
  for (const char *key : {"camera", "outputs", "warnings", "modulation_hz", "sensor"})
    told.erase(key);
  manifest["correction"] = std::move(told);
  ordered_json entry = frame_json(record);
  for (const char *of_measuring : measuring_keys) {
    manifest.erase(of_measuring);
    entry.erase(of_measuring);
  }
  manifest["frames"] = ordered_json::array({std::move(entry)});
  return manifest;
}

std::vector<std::string> write(const Outcome &outcome, const Setup &setup, const Options &options,
                               OutputSet &files) {
  const Sensor &camera = outcome.scenery.camera();
  const auto channels = std::make_shared<const CorrectedChannels>(outcome.corrected, camera);
  const std::uint32_t frame = outcome.options.frame;
  const auto to_write = std::make_shared<const FrameToWrite>(
      FrameToWrite{camera, frame, setup.frames.time_s(frame), channels->set, channels, channels->normals});
  files.add(write_files(files.directory(), files_of(to_write, options.capture.formats)));
  const ordered_json manifest = manifest_of(outcome, setup, options, files.paths());
  files.add(manifest_name, [&](OutputFile &file) { file.write(json_text(manifest)); });
  throw_if_interrupted();
  files.publish();
  return files.paths();
}

// The scene counts where true ranges come from it, or poses are at its nodes; else it is not read.
Setup setup_of(const CaptureRequest &request, bool for_truth) {
  const SetupDocument document = requested_document(request, request.setup);
  const bool has_scene = document.json.is_object() && document.json.contains("scene");
  if (for_truth && !has_scene)
    throw Error(ExitCode::usage,
                fmt::format("--truth scene: {} has no \"scene\", expected an image of ranges",
                            request.setup.string()));
  if (!has_scene || !(for_truth || names_nodes(document)))
    return requested_setup_without_scene(request, document);
  SetupLoader loader;
  return requested_setup(request, document, loader);
}

// The image, with the files that went into it among the setup's.
MeasuredFile measured_of(const CorrectOptions &wanted, const Scenery &scenery, Setup &setup) {
  const FilesRead of_image(setup.file.parent_path());
  MeasuredFile measured = read_measured(wanted.image, scenery.camera(), wanted.frame);
  std::ranges::copy(of_image.list(), std::back_inserter(setup.inputs));
  for (const Warning &warning : measured.warnings)
    warn(warning);
  return measured;
}

// What ranges are compared with.
struct Truth {
  std::string name; // empty: nothing
  std::vector<double> range_m, lit;
};

// A file, `scene`, or nothing.
std::string wanted_truth(const CorrectOptions &options, const MeasuredFile &measured, const Scenery &scenery,
                         const Setup &setup) {
  // Ranges that are means over several samples of a pixel are none of its centre.
  const bool means = !measured.range_m.empty() && scenery.camera().samples > 1;
  return options.truth.empty() && means && setup.as_used.contains("scene") ? truth_of_scene : options.truth;
}

Truth truth_for(const std::string &wanted, const Options &options, const MeasuredFile &measured,
                const Scenery &scenery, ProgressBar &bar) {
  Truth truth{measured.range_m.empty() ? "" : "range_m of the same file", measured.range_m, measured.lit};
  if (wanted.empty())
    return truth;
  bar.begin("truth", 1.0);
  TruthFile read = wanted == truth_of_scene
                       ? truth_of(scenery_of(setup_of(options.capture, true), options.correct),
                                  interruptible_progress(bar))
                       : read_truth(wanted, scenery.camera());
  truth.name = wanted == truth_of_scene ? "the scene, at the pixels' centres" : wanted;
  truth.range_m = std::move(read.range_m);
  if (!read.lit.empty())
    truth.lit = std::move(read.lit);
  return truth;
}

} // namespace

void run_correct(const Options &options) {
  const CorrectOptions &wanted = options.correct;
  Setup setup = setup_of(options.capture, wanted.truth == truth_of_scene);
  require_names_for_files(setup.start.sensors);
  const Scenery scenery = scenery_of(setup, wanted);
  const MeasuredFile measured = measured_of(wanted, scenery, setup);
  ask_for_memory(scenery.camera().pixel_count() * bytes_of_corrected_pixel,
                 fmt::format("the correction of {} pixels", scenery.camera().pixel_count()),
                 "take a sensor of fewer pixels");
  refuse_other_run(options.capture.output_directory);
  OutputSet files(options.capture.output_directory); // first, so that nothing is computed in vain
  const std::string true_ranges = wanted_truth(wanted, measured, scenery, setup);
  ProgressBar bar(true_ranges.empty() ? 1.0 : 2.0);
  const Truth truth = truth_for(true_ranges, options, measured, scenery, bar);
  bar.begin("correction", 1.0);
  const CorrectionOptions how{.frequency = wanted.image.frequency,
                              .backscatter = setup.backscatter,
                              .least_range_m = wanted.image.least_range_m.value_or(0.0),
                              .normals = wanted.normals,
                              .fit_pixels = wanted.fit_pixels};
  Outcome outcome{measured, scenery, wanted,
                  correct(scenery.camera(), scenery.instant.illuminators, measured.image, how,
                          interruptible_progress(bar)),
                  truth.name};
  outcome.effects = not_corrected(setup, scenery);
  outcome.warnings = setup.warnings;
  std::ranges::copy(measured.warnings, std::back_inserter(outcome.warnings));
  if (!truth.name.empty()) {
    outcome.errors = error_rows(outcome.corrected, truth.range_m, truth.lit);
    outcome.wrong_turns =
        wrong_turns(outcome.corrected, truth.range_m, scenery.camera().ambiguity_m(wanted.image.frequency));
  }
  outcome.outputs = write(outcome, setup, options, files);
  print(options.json ? json_text(json_of(outcome)) : text_of(outcome));
}

} // namespace pmdsim
