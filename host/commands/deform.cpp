#include "host/capture/capture.h"
#include "host/capture/progress.h"
#include "host/commands/commands.h"
#include "host/commands/report_of_run.h"
#include "host/output/files/manifest.h"
#include "host/output/pictures/plots.h"
#include "host/output/sheets/sheets.h"
#include "host/output/tables/deformation.h"
#include "host/output/tables/profile.h"
#include "host/report/report.h"

#include <algorithm>
#include <array>
#include <deque>
#include <fmt/format.h>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// A map each frequency of one frame.
using Maps = std::vector<std::vector<double>>;

// The report of one sensor's frame, to scripts and people.
struct DeformedFrame {
  FrameRecord record{};                            // its accuracy is the deformation's
  std::vector<DeformationStatistics> statistics{}; // of each frequency
};

// The errors of two distances add up in their difference, at worst. It has no amplitude.
AccuracyReport of_difference(const AccuracyReport &bistatic, const AccuracyReport &monostatic) {
  const auto sum = [](const std::optional<double> &a, const std::optional<double> &b) {
    return a && b ? std::optional(*a + *b) : std::nullopt;
  };
  AccuracyReport difference = bistatic;
  difference.claimed_m = sum(bistatic.claimed_m, monostatic.claimed_m);
  difference.found_m = sum(bistatic.found_m, monostatic.found_m);
  difference.claimed_amplitude = difference.found_amplitude = std::nullopt;
  difference.unpromised = bistatic.unpromised + monostatic.unpromised;
  difference.checked_pixels = std::min(bistatic.checked_pixels, monostatic.checked_pixels);
  difference.check_ms += monostatic.check_ms;
  return difference;
}

// One sensor's frame, taken both ways.
struct TakenPair {
  TakenFrame bistatic;
  Maps monostatic_m, deformations_mm;           // the latter, and the next, once it is written
  std::vector<std::vector<float>> rounded_mm{}; // deformations
};

// Wrapped, a map each frequency.
Maps deformations_mm(const TakenPair &pair) {
  Maps deformations;
  for (std::size_t i = 0; i < pair.monostatic_m.size(); ++i)
    deformations.push_back(deformation_mm(pair.bistatic.measurement.returns[i].unrounded_distance_m,
                                          pair.monostatic_m[i], pair.bistatic.sensor.ambiguity_m(i)));
  return deformations;
}

FileToWrite profile_plot(const std::shared_ptr<const FrameToWrite> &frame, const Channel &deformation) {
  const std::string stem = frame_file_stem(frame->sensor, frame->frame);
  const std::string name = channel_name("deformation_profile", deformation.frequency);
  return {fmt::format("{}.{}.png", stem, name), [frame, &deformation](OutputFile &file) {
            throw_if_interrupted();
            const glm::uvec2 &resolution = frame->channels.resolution;
            const std::string quantity = fmt::format("deformation along row {}", profile_row(resolution));
            const std::scoped_lock alone(drawing_mutex());
            draw_profile(std::get<std::span<const float>>(deformation.values), resolution, "deformation",
                         "mm", picture_title(quantity, *frame, deformation.frequency))
                .write_png(file);
          }};
}

// The distance is always measured.
bool is_asked_for(const Channel &channel, const WantedChannels &channels) {
  const ChannelRow &distance = row_of(&Return::distance_m);
  return channel.quantity != distance.name || channels.has({distance, channel.frequency.value_or(0)});
}

// The deformations, where they are asked for, come first.
std::shared_ptr<const FrameToWrite> deformation_frame(const std::shared_ptr<const TakenPair> &pair,
                                                      const FrameRecord &record, const Capture &capture) {
  const Measurement &bistatic = pair->bistatic.measurement;
  const bool is_unrounded = capture.output_precision() == OutputPrecision::float64;
  const Maps &deformations = pair->deformations_mm;
  ChannelSet set{bistatic.resolution, {}};
  const bool has_deformation = capture.channels().has_own(deformation_channel);
  for (std::size_t i = 0; has_deformation && i < deformations.size(); ++i)
    set.channels.push_back(
        {deformation_channel, "mm", std::span(pair->rounded_mm[i]), frequency_of(i, deformations.size()),
         Preview{"deformation", ColourScale::zero_centred}, "bistatic minus monostatic distance, wrapped",
         is_unrounded ? std::span<const double>(deformations[i]) : std::span<const double>()});
  ChannelSet measured = channels_of(bistatic);
  for (Channel &channel : measured.channels)
    if (is_asked_for(channel, capture.channels())) {
      channel.preview = std::nullopt;
      if (!is_unrounded)
        channel.unrounded = {};
      set.channels.push_back(std::move(channel));
    }
  return std::make_shared<const FrameToWrite>(FrameToWrite{pair->bistatic.sensor, record.frame, record.time_s,
                                                           std::move(set), pair, pair->bistatic.normals});
}

std::vector<FileToWrite> deformation_files(const std::shared_ptr<const FrameToWrite> &frame,
                                           const std::set<Format> &formats) {
  std::vector<FileToWrite> files = files_of(frame, formats);
  if (formats.contains(Format::png))
    for (const Channel &channel : frame->channels.channels)
      if (channel.quantity == deformation_channel)
        files.push_back(profile_plot(frame, channel));
  return files;
}

// Takes the monostatic frame, whose distances stay, and then the bistatic one. Each is told when the next
// begins.
std::shared_ptr<TakenPair> take_pair(Capture &capture, const SensorFrame &at, DeformedFrame &told) {
  auto pair = std::make_shared<TakenPair>();
  pair->bistatic = capture.take(at, Light::in_lens, at.time_s, ", monostatic");
  for (Return &of_frequency : pair->bistatic.measurement.returns)
    pair->monostatic_m.push_back(std::move(of_frequency.unrounded_distance_m));
  const AccuracyReport monostatic = pair->bistatic.measurement.accuracy;
  pair->bistatic = {}; // its memory first
  pair->bistatic = capture.take(at, Light::beside_lens, at.next_s, ", bistatic");
  told.record = record_of(pair->bistatic, at);
  told.record.accuracy = of_difference(told.record.accuracy, monostatic);
  return pair;
}

const std::array<std::pair<const char *, double DeformationStatistics::*>, 6> figures{
    {{"mean", &DeformationStatistics::mean_mm},
     {"min", &DeformationStatistics::min_mm},
     {"max", &DeformationStatistics::max_mm},
     {"centre", &DeformationStatistics::centre_mm},
     {"rms", &DeformationStatistics::rms_mm},
     {"varying", &DeformationStatistics::varying_mm}}};

ordered_json statistics_json(const DeformationStatistics &statistics) {
  ordered_json json;
  for (const auto &[name, figure] : figures)
    json[name] = statistics.*figure;
  return json;
}

ordered_json deformed_json(const DeformedFrame &frame) {
  const FrameRecord &record = frame.record;
  ordered_json json{{"sensor", record.sensor.name},
                    {"frame", record.frame},
                    {"time_s", record.time_s},
                    {"modulation_hz", record.sensor.modulation_hz},
                    {"deformation_mm", array_of(frame.statistics, statistics_json)}};
  json.update(accuracy_json(record));
  if (record.bounces) // of the bistatic frame
    json["bounces"] = bounces_json(*record.bounces);
  return json;
}

// Deformations and their statistics are computed where the frame is written, while the next is measured.
// Returns the sensors' parts of the first frame that is made here.
std::deque<DeformedFrame> deform(Capture &capture) {
  std::deque<DeformedFrame> first; // its elements stay where they are, as writers fill them in
  const auto measure = [&](const SensorFrame &at) -> MeasuredPart {
    auto told = std::make_shared<DeformedFrame>();
    const std::shared_ptr<TakenPair> pair = take_pair(capture, at, *told);
    DeformedFrame *kept =
        first.empty() || first.front().record.frame == at.frame ? &first.emplace_back(*told) : nullptr;
    const bool in_sheets = at.is_in_sheets && capture.formats().contains(Format::png);
    return {record_of(pair->bistatic, at), [pair, told, kept, in_sheets, &capture](FrameRecord &record) {
              pair->deformations_mm = deformations_mm(*pair);
              for (const std::vector<double> &deformation : pair->deformations_mm) {
                told->statistics.push_back(statistics_of(deformation, pair->bistatic.measurement.resolution));
                pair->rounded_mm.emplace_back(deformation.begin(), deformation.end());
              }
              record.told = deformed_json(*told);
              if (kept)
                kept->statistics = told->statistics;
              const auto frame = deformation_frame(pair, told->record, capture);
              if (in_sheets)
                record.thumbnails = thumbnails_json(frame->channels);
              return deformation_files(frame, capture.formats());
            }};
  };
  capture.write(measure, bytes_of_largest_frame(capture.setup(), false, capture.channels(), 3, true), 2.0);
  return first;
}

// Where there are no frames, as in a shard of few, there is no first one.
ordered_json first_statistics_json(const Capture &capture) {
  ordered_json first;
  capture.for_each_sensor_frame([&](const ordered_json &of_sensor) {
    if (first.is_null())
      first = of_sensor.at("told").at("deformation_mm").at(0);
  });
  return first;
}

void print_deform_json(const Capture &capture, const std::string &report) {
  const FrameSequence &sequence = capture.sequence();
  ordered_json head{{"deformation_mm", first_statistics_json(capture)}};
  if (!report.empty())
    head["report"] = report;
  JsonPieces pieces([](std::string_view text) { print(std::string(text)); }, head);
  pieces.list("frames", [&](const JsonPieces::Add &add) {
    capture.for_each_sensor_frame([&](const ordered_json &of_sensor) { add(of_sensor.at("told")); });
  });
  pieces.list("outputs", [&](const JsonPieces::Add &add) {
    capture.for_each_sensor_frame([&](const ordered_json &of_sensor) {
      for (const std::string name : of_sensor.at("manifest").at("outputs"))
        add(sequence.path_of(name));
    });
    for (const std::string &name : sequence.sheets())
      add(sequence.path_of(name));
    add(sequence.path_of(manifest_name));
  });
  pieces.end();
}

// One row a sensor and frequency.
std::string table_text(const std::deque<DeformedFrame> &frames) {
  std::size_t width = 0;
  std::vector<std::pair<std::string, DeformationStatistics>> rows;
  for (const DeformedFrame &frame : frames)
    for (std::size_t i = 0; i < frame.statistics.size(); ++i) {
      const Sensor &sensor = frame.record.sensor;
      rows.emplace_back(fmt::format("{}, {}", sensor.name, frequency_text(sensor.modulation_hz[i])),
                        frame.statistics[i]);
      width = std::max(width, rows.back().first.size());
    }
  std::string text(width, ' ');
  for (const auto &[name, figure] : figures)
    text += fmt::format("{:>12}", name);
  for (const auto &[label, statistics] : rows) {
    text += fmt::format("\n{:<{}}", label, width);
    for (const auto &[name, figure] : figures)
      text += fmt::format("{:>12}", table_number(statistics.*figure));
  }
  return text + '\n';
}

// `first` is empty where nothing was left to do here.
std::string report_text(const std::deque<DeformedFrame> &first, const Capture &capture) {
  std::string text = capture.device_text();
  if (!first.empty()) {
    text += "deformation (bistatic - monostatic distance), mm\n" + table_text(first);
    if (capture.frame_count() > 1)
      text += fmt::format("of frame {}; --json tells of all\n", first.front().record.frame);
  }
  for (const DeformedFrame &frame : first)
    if (const std::string said = accuracy_text(frame.record.mode, frame.record.accuracy); !said.empty())
      text += fmt::format("\n{}\n{}", frame.record.sensor.name, said);
  return text + "\n" + capture.sequence().written_text();
}

} // namespace

void run_deform(const Options &options) {
  Setup setup = requested_setup(options.capture);
  leave_out_electronics(setup);
  const WantedChannels measured = options.capture.channels.with(row_of(&Return::distance_m));
  constexpr bool keep_unrounded = true;
  Capture capture(options.capture, std::move(setup), "deform", false, measured, keep_unrounded);
  const std::deque<DeformedFrame> first = deform(capture);
  const std::string report = report_of_run(options, capture);
  if (options.json)
    print_deform_json(capture, report);
  else
    print(report_text(first, capture) + report_line(report));
}

} // namespace pmdsim
