#include "host/capture/capture.h"
#include "host/capture/interruption.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/output/pictures/profile_plot.h"
#include "host/output/tables/deformation.h"
#include "host/output/tables/profile.h"
#include "host/report/report.h"

#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// Deformations of one frame, a map each frequency.
using Maps = std::vector<std::vector<float>>;

// What scripts and people are told of one sensor's frame.
struct DeformedFrame {
  std::uint32_t frame;
  double time_s;
  std::string sensor;
  std::vector<double> modulation_hz;
  std::vector<DeformationStatistics> statistics; // of each frequency
  Mode mode;
  AccuracyReport accuracy; // of the deformation
};

// What is kept of the frame with the light in the lens while the other is measured.
struct Monostatic {
  Maps distances_m;
  AccuracyReport accuracy;
};

Monostatic take_monostatic(Capture &capture, const SensorFrame &at) {
  TakenFrame frame = capture.take(at, Light::in_lens, at.time_s, ", monostatic");
  Monostatic monostatic{{}, frame.measurement.accuracy};
  for (Return &of_frequency : frame.measurement.returns)
    monostatic.distances_m.push_back(std::move(of_frequency.distance_m));
  return monostatic;
}

// The errors of two distances add up in their difference, at worst. It has no amplitude.
AccuracyReport of_difference(const AccuracyReport &bistatic, const AccuracyReport &monostatic) {
  const auto sum = [](const std::optional<double> &a, const std::optional<double> &b) {
    return a && b ? std::optional(*a + *b) : std::nullopt;
  };
  AccuracyReport difference = bistatic;
  difference.claimed_m = sum(bistatic.claimed_m, monostatic.claimed_m);
  difference.found_m = sum(bistatic.found_m, monostatic.found_m);
  difference.claimed_amplitude = difference.found_amplitude = std::nullopt;
  difference.checked_pixels = std::min(bistatic.checked_pixels, monostatic.checked_pixels);
  difference.check_ms += monostatic.check_ms;
  return difference;
}

// Wrapped, a map each frequency.
Maps deformations_mm(const TakenFrame &bistatic, const Maps &monostatic_m) {
  Maps deformations;
  for (std::size_t i = 0; i < monostatic_m.size(); ++i)
    deformations.push_back(deformation_mm(bistatic.measurement.returns[i].distance_m, monostatic_m[i],
                                          bistatic.sensor.ambiguity_m(i)));
  return deformations;
}

// One sensor's frame, taken both ways.
struct TakenPair {
  TakenFrame bistatic;
  Maps monostatic_m;
  Maps deformations_mm{}; // once it is written
};

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

std::vector<FileToWrite> deformation_files(const std::shared_ptr<const TakenPair> &pair,
                                           std::uint32_t frame_number, const std::set<Format> &formats) {
  const Measurement &bistatic = pair->bistatic.measurement;
  const Maps &deformations = pair->deformations_mm;
  ChannelSet set{bistatic.resolution, {}};
  for (std::size_t i = 0; i < deformations.size(); ++i)
    set.channels.push_back({"deformation_mm", "mm", std::span(deformations[i]),
                            frequency_of(i, deformations.size()),
                            Preview{"deformation", ColourScale::zero_centred}});
  ChannelSet measured = channels_of(bistatic);
  for (Channel &channel : measured.channels) {
    channel.preview = std::nullopt;
    set.channels.push_back(std::move(channel));
  }
  const auto frame = std::make_shared<const FrameToWrite>(
      FrameToWrite{pair->bistatic.sensor, frame_number, std::move(set), pair});
  std::vector<FileToWrite> files = files_of(frame, formats);
  if (formats.contains(Format::png))
    for (std::size_t i = 0; i < deformations.size(); ++i)
      files.push_back(profile_plot(frame, frame->channels.channels[i]));
  return files;
}

// The bistatic frame after the monostatic one, as the next frame's begins.
std::shared_ptr<TakenPair> take_pair(Capture &capture, const SensorFrame &at, DeformedFrame &told) {
  Monostatic monostatic = take_monostatic(capture, at);
  auto pair = std::make_shared<TakenPair>(TakenPair{
      capture.take(at, Light::beside_lens, at.next_s, ", bistatic"), std::move(monostatic.distances_m)});
  const auto &[sensor, measurement, mode] = pair->bistatic;
  told = {at.frame,
          at.time_s,
          sensor.name,
          sensor.modulation_hz,
          {},
          mode,
          of_difference(measurement.accuracy, monostatic.accuracy)};
  return pair;
}

// Of the setup's largest frame.
std::size_t bytes_of_pair(const Setup &setup) {
  std::size_t most = 0;
  for (const Sensor &sensor : setup.start.sensors) {
    const std::size_t maps = 2 * sensor.modulation_hz.size();
    most = std::max(most, bytes_of_frame(sensor, false) + maps * sizeof(float) * sensor.pixel_count());
  }
  return most;
}

// Deformations and their statistics are computed where the frame is written, while the next is measured.
std::deque<DeformedFrame> deform(Capture &capture) {
  std::deque<DeformedFrame> deformed; // its elements stay where they are, as writers fill them in
  const auto measure = [&](const SensorFrame &at) -> MeasuredPart {
    DeformedFrame &told = deformed.emplace_back();
    const std::shared_ptr<TakenPair> pair = take_pair(capture, at, told);
    return {record_of(pair->bistatic, at), [pair, &told, &formats = capture.formats()] {
              pair->deformations_mm = deformations_mm(pair->bistatic, pair->monostatic_m);
              for (const std::vector<float> &deformation : pair->deformations_mm)
                told.statistics.push_back(statistics_of(deformation, pair->bistatic.measurement.resolution));
              return deformation_files(pair, told.frame, formats);
            }};
  };
  capture.write(measure, bytes_of_pair(capture.setup()));
  return deformed;
}

ordered_json statistics_json(const DeformationStatistics &statistics) {
  return {{"mean", statistics.mean_mm},
          {"min", statistics.min_mm},
          {"max", statistics.max_mm},
          {"centre", statistics.centre_mm},
          {"rms", statistics.rms_mm}};
}

ordered_json report_json(const std::deque<DeformedFrame> &frames, const FrameSequence &sequence) {
  ordered_json list = ordered_json::array();
  for (const DeformedFrame &frame : frames) {
    ordered_json deformations = ordered_json::array();
    for (const DeformationStatistics &statistics : frame.statistics)
      deformations.push_back(statistics_json(statistics));
    list.push_back({{"sensor", frame.sensor},
                    {"frame", frame.frame},
                    {"time_s", frame.time_s},
                    {"modulation_hz", frame.modulation_hz},
                    {"deformation_mm", deformations},
                    {"mode", mode_name(frame.mode)}});
    list.back().update(accuracy_json(frame.accuracy));
  }
  return {{"deformation_mm", statistics_json(frames.front().statistics.front())},
          {"frames", list},
          {"outputs", sequence.paths()}};
}

// Of the first frame, one row a sensor and frequency.
std::string table_text(const std::deque<DeformedFrame> &frames) {
  std::size_t width = 0;
  std::vector<std::pair<std::string, DeformationStatistics>> rows;
  for (const DeformedFrame &frame : frames)
    for (std::size_t i = 0; frame.frame == frames.front().frame && i < frame.statistics.size(); ++i) {
      rows.emplace_back(fmt::format("{}, {}", frame.sensor, frequency_text(frame.modulation_hz[i])),
                        frame.statistics[i]);
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

// Of the first frame's deformations, sensor by sensor.
std::string accuracies_text(const std::deque<DeformedFrame> &frames) {
  std::string text;
  for (const DeformedFrame &frame : frames)
    if (const std::string said = accuracy_text(frame.mode, frame.accuracy);
        frame.frame == frames.front().frame && !said.empty())
      text += fmt::format("\n{}\n{}", frame.sensor, said);
  return text;
}

std::string report_text(const std::deque<DeformedFrame> &frames, const Capture &capture) {
  std::string text =
      capture.device_text() + "deformation (bistatic - monostatic distance), mm\n" + table_text(frames);
  if (frames.back().frame != frames.front().frame)
    text += fmt::format("of frame {}; --json tells of all\n", frames.front().frame);
  return text + accuracies_text(frames) + "\n" + capture.sequence().written_text();
}

} // namespace

void run_deform(const Options &options) {
  Capture capture(options.capture, "deform", false, 2.0);
  const std::deque<DeformedFrame> deformed = deform(capture);
  if (options.json)
    print(report_json(deformed, capture.sequence()));
  else
    print(report_text(deformed, capture));
}

} // namespace pmdsim
