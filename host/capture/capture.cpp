#include "host/capture/capture.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/memory/memory_limit.h"
#include "host/output/sheets/sheets.h"
#include "host/report/frame_findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// Throws Error: (usage) where the setup has not so many, or not the channels, (input) where a sensor's frames
// cannot become files.
FrameRange frames_to_write(const CaptureRequest &request, const Setup &setup) {
  const FrameRange frames = request.frames.value_or(FrameRange{0, setup.frames.count});
  if (frames.end > setup.frames.count)
    throw Error(ExitCode::usage,
                fmt::format("--frames {}:{}: expected B at most {}, the frames of {}", frames.first,
                            frames.end, setup.frames.count, setup.file.string()));
  return request.shard.of(frames);
}

nlohmann::ordered_json inputs_json(const std::vector<FileRead> &inputs) {
  return array_of(inputs, [](const FileRead &file) {
    return nlohmann::ordered_json{{"file", file.path}, {"bytes", file.bytes}, {"xxh3_128", file.hash}};
  });
}

// The setup's warnings, whose files are named relative to its folder: a run is the same wherever it is begun.
std::vector<Warning> beside_setup(const Setup &setup) {
  std::vector<Warning> warnings = setup.warnings;
  const std::string folder = (setup.file.parent_path() / "").string();
  for (Warning &warning : warnings)
    if (!folder.empty() && warning.place.starts_with(folder))
      warning.place.erase(0, folder.size());
  return warnings;
}

RunHead by_camera(RunHead head, const Camera &camera) {
  head.device = camera.device();
  head.driver = camera.driver();
  return head;
}

bool has_distances(const std::set<Format> &formats) {
  return formats.empty() || std::ranges::any_of(formats, [](Format format) { return format != Format::png; });
}

} // namespace

RunHead head_of(const CaptureRequest &request, const Setup &setup, const std::string &command) {
  RunHead head{.command = command,
               .accuracy = request.accuracy,
               .paths = request.paths,
               .setup = setup.as_used,
               .objects = setup.start.scene.objects,
               .inputs = inputs_json(setup.inputs)};
  for (const Format format : request.formats)
    head.formats.push_back(format_name(format));
  head.channels = request.channels.names();
  head.output_precision = request.output_precision;
  head.warnings = beside_setup(setup);
  return head;
}

SetupDocument requested_document(const CaptureRequest &request, const std::filesystem::path &file) {
  SetupDocument document = read_setup_document(file);
  document.scene_files = request.scene_files;
  if (request.poses)
    change(document, changes_for(*request.poses, document), "--poses");
  change(document, request.changes, "--set");
  return document;
}

Setup requested_setup(const CaptureRequest &request) {
  SetupLoader loader;
  return requested_setup(request, requested_document(request, request.setup), loader);
}

void require_measurable(const CaptureRequest &request, const Setup &setup) {
  if (request.paths > 0 && !setup.bounces.any())
    throw Error(ExitCode::usage, fmt::format("--paths: no light bounces in {}, expected \"bounces\" above 0",
                                             setup.file.string()));
  frames_to_write(request, setup);
  require_names_for_files(setup.start.sensors);
  request.channels.require_in(setup, request.accuracy);
  if (request.accuracy.strict && request.accuracy.mode != Mode::exact && exposes_any_tap_by_tap(setup))
    throw Error(ExitCode::accuracy, fmt::format("--strict: {}", tap_by_tap_is_exact));
  if (request.formats.contains(Format::ply) && !request.channels.has(row_of(&Return::distance_m)) &&
      !request.channels.has(row_of(&Measurement::unwrapped_distance_m)))
    throw Error(ExitCode::usage, "--format ply: points need a distance, expected distance_m or "
                                 "unwrapped_distance_m among --channels");
  if (request.formats == std::set{Format::png} && !request.channels.have_previews())
    throw Error(ExitCode::usage, "--format png: no picture is made of any of --channels, expected another "
                                 "format beside it");
  if (request.output_precision == OutputPrecision::float64 && !has_distances(request.formats))
    throw Error(ExitCode::usage, "--output-precision float64: only exr, npz, h5, npy and csv hold values; "
                                 "expected one of them among --format");
  if (request.accuracy.strict)
    refuse_warnings(setup.warnings);
}

namespace {

// What is asked for instead of the setup's own values, and its warnings.
Setup with_request(Setup setup, const CaptureRequest &request) {
  if (request.accuracy.strict)
    refuse_warnings(setup.warnings);
  for (const Warning &warning : setup.warnings)
    warn(warning);
  if (request.accuracy.mode != Mode::exact && !request.accuracy.strict && exposes_any_tap_by_tap(setup))
    warn(tap_by_tap_warning(setup));
  if (request.samples)
    set_samples(setup, *request.samples);
  return setup;
}

} // namespace

Setup requested_setup(const CaptureRequest &request, const SetupDocument &document, SetupLoader &loader) {
  return with_request(loader.load(document), request);
}

Setup requested_setup_without_scene(const CaptureRequest &request, const SetupDocument &document) {
  return with_request(SetupLoader::load_without_scene(document), request);
}

Setup requested_setup_without_bounces(const CaptureRequest &request) {
  Setup setup = requested_setup(request);
  if (setup.bounces.any())
    warn(input_warning(warning_code("bounces-left-out"), Place{setup.file} / "bounces",
                       "light that bounces is left out, as sums over the diodes are compared"));
  setup.bounces = {};
  return setup;
}

void leave_out_electronics(Setup &setup) {
  bool any = false;
  for (Sensor &sensor : setup.start.sensors) {
    any = any || sensor.electronics || !sensor.scatter.empty() || sensor.unwrap_range_m > 0.0;
    sensor.electronics.reset();
    sensor.scatter.clear();
    sensor.unwrap_range_m = 0.0;
  }
  for (auto &sensor : setup.as_used["sensors"]) {
    sensor.erase("electronics");
    sensor.erase("unwrap_range_m");
    sensor["scatter"] = nlohmann::ordered_json::array();
  }
  if (any)
    warn(input_warning(warning_code("electronics-left-out"), Place{setup.file} / "sensors",
                       "electronics, scatter and unwrapping are left out, as frames without noise are "
                       "compared"));
}

namespace {

std::vector<Warning> of_frame(std::vector<Warning> warnings, std::uint32_t frame) {
  for (Warning &warning : warnings)
    warning.place += fmt::format(", frame {}", frame);
  return warnings;
}

Setup measurable(const CaptureRequest &request, Setup setup) {
  require_measurable(request, setup);
  return setup;
}

} // namespace

Capture::Capture(const CaptureRequest &request, Setup setup, const std::string &command, bool keep_taps,
                 const WantedChannels &measured, const std::shared_ptr<Camera> &camera, bool keep_unrounded)
    : setup_(measurable(request, std::move(setup))), frames_(frames_to_write(request, setup_)),
      formats_(request.formats), channels_(request.channels), accuracy_(request.accuracy),
      part_(request.part), exposures_(setup_, camera, keep_taps, request.accuracy, request.paths, measured,
                                      keep_unrounded || request.output_precision == OutputPrecision::float64),
      sequence_(setup_,
                {frames_, request.output_directory,
                 request.resume ? RunFolder::Earlier::kept : RunFolder::Earlier::made_again,
                 request.accuracy.strict},
                by_camera(head_of(request, setup_, command), exposures_.camera())) {}

std::string Capture::device_text() const {
  return fmt::format("device    {} ({})\n\n", exposures_.camera().device(), exposures_.camera().driver());
}

TakenFrame Capture::take(const SensorFrame &at, Light light, std::optional<double> next_s,
                         const std::string &label) {
  bar_->begin(at.label + label, samples_of_frame(setup_, setup_.start.sensors[at.sensor]));
  const bool was_lost = !exposures_.loss().empty();
  TakenFrame taken = exposures_.take(at.sensor, at.frame, light, interruptible_progress(*bar_), next_s);
  if (!was_lost && !exposures_.loss().empty())
    tell(fmt::format("note: {}; it was set up anew, and frame {} was made again", exposures_.loss(),
                     at.frame));
  taken.warnings = frame_warnings(setup_, taken.sensor, taken.measurement, accuracy_);
  if (sequence().run().command == "deform") // whose differences do not mind how often a distance wraps
    std::erase_if(taken.warnings, [](const Warning &warning) { return warning.code == "beyond-ambiguity"; });
  if (accuracy_.strict)
    refuse_warnings(of_frame(taken.warnings, at.frame));
  for (const Warning &warning : taken.warnings)
    warnings_.add(warning, at.frame);
  if (formats_.contains(Format::ply))
    taken.normals = exposures_.normals_of(taken, at.time_s);
  return taken;
}

void Capture::write(const FrameSequence::Measure &measure, std::size_t part_bytes,
                    double exposures_of_sample) {
  const std::uint64_t room = room_for_waiting(part_bytes + bytes_of_normals());
  const double work_of_frame = exposures_of_sample * samples_of_frame(setup_);
  bar_.emplace(sequence_.begin() * work_of_frame, part_);
  const auto measure_next = [&](const SensorFrame &at) {
    if (at.sensor == 0)
      bar_->reach(at.frames_done * work_of_frame);
    return measure(at);
  };
  try {
    sequence_.write(measure_next, part_bytes + bytes_of_normals(), room);
  } catch (...) {
    tell_warnings();
    throw;
  }
  tell_warnings();
}

// What is left beside a frame that is measured and one that is written. Throws Error (out_of_memory) where
// these do not fit.
std::uint64_t Capture::room_for_waiting(std::size_t part_bytes) const {
  const Camera &camera = exposures_.camera();
  std::uint64_t most = 0;
  for (const Sensor &sensor : setup_.start.sensors) {
    const auto forecast_in = [&](std::uint32_t max_strip_samples) {
      return forecast_of(setup_, sensor, camera.extras(), camera.measured_by(), part_bytes,
                         max_strip_samples);
    };
    MemoryForecast forecast = forecast_in(0);
    if (!camera.is_reference() && lack_of_memory(camera.further_bytes(forecast)))
      forecast = forecast_in(short_strip_samples);
    const std::uint64_t further = camera.further_bytes(forecast);
    if (const auto lack = lack_of_memory(further))
      throw lacking_memory(sensor, forecast, *lack);
    most = std::max(most, further);
  }
  const std::uint64_t left = memory_left();
  return left - std::min(left, most);
}

void Capture::tell_warnings() {
  bar_.reset(); // before anything is printed
  for (const Warning &warning : warnings_.merged())
    warn(warning);
}

std::size_t Capture::bytes_of_normals() const {
  std::size_t most = 0;
  for (const Sensor &sensor : setup_.start.sensors)
    most = std::max<std::size_t>(most, sensor.pixel_count() * sizeof(glm::vec3));
  return formats_.contains(Format::ply) ? most : 0;
}

void Capture::for_each_sensor_frame(const std::function<void(const nlohmann::ordered_json &)> &use) const {
  sequence_.for_each_record([&](const nlohmann::ordered_json &record) {
    for (const auto &of_sensor : record.at("sensors"))
      use(of_sensor);
  });
}

FrameRecord record_of(const TakenFrame &taken, const SensorFrame &at) {
  const auto &[sensor, measurement, mode, normals, warnings] = taken;
  FrameRecord record{sensor,
                     at.frame,
                     at.time_s,
                     measurement.frame_ms,
                     measurement.passes,
                     mode,
                     measurement.accuracy,
                     measurement.bounces};
  record.warnings = warnings;
  return record;
}

MeasuredPart rendered_frame(const std::shared_ptr<const TakenFrame> &taken, const SensorFrame &at,
                            const std::set<Format> &formats, std::span<const std::string> objects) {
  auto frame = std::make_shared<const FrameToWrite>(FrameToWrite{
      taken->sensor, at.frame, at.time_s, channels_of(taken->measurement), taken, taken->normals, objects});
  const bool in_sheets = at.is_in_sheets && formats.contains(Format::png);
  return {record_of(*taken, at), [frame = std::move(frame), formats, in_sheets](FrameRecord &record) {
            if (in_sheets)
              record.thumbnails = thumbnails_json(frame->channels);
            return files_of(frame, formats);
          }};
}

std::size_t bytes_of_largest_frame(const Setup &setup, bool keep_taps, const WantedChannels &wanted,
                                   std::size_t maps, bool keep_unrounded) {
  std::size_t most = 0;
  for (const Sensor &sensor : setup.start.sensors) {
    const std::size_t values = maps * sensor.modulation_hz.size() * sensor.pixel_count();
    most = std::max(most, bytes_of_frame(sensor, keep_taps, setup.bounces, wanted, keep_unrounded) +
                              values * sizeof(double));
  }
  return most;
}

} // namespace pmdsim
