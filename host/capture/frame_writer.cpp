#include "host/capture/frame_writer.h"

#include "engine/model/error.h"
#include "host/capture/progress.h"
#include "host/output/clouds/cloud_picture.h"
#include "host/output/clouds/ply_writer.h"
#include "host/output/files/h5_writer.h"
#include "host/output/pictures/preview.h"
#include "host/output/tables/profile.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace pmdsim {
namespace {

void write_preview(OutputFile &file, const FrameToWrite &frame, const Channel &channel) {
  const Preview &preview = *channel.preview;
  const glm::uvec2 &resolution = frame.channels.resolution;
  const std::string title = picture_title(std::string(preview.quantity), frame, channel.frequency);
  const std::scoped_lock alone(drawing_mutex());
  if (const auto *ids = std::get_if<std::span<const std::uint32_t>>(&channel.values))
    draw_preview(*ids, resolution, title,
                 channel.name() == row_of(&Measurement::object_id).name ? frame.objects
                                                                        : std::span<const std::string>())
        .write_png(file);
  else
    draw_preview(std::get<std::span<const float>>(channel.values), resolution, preview, channel.unit, title)
        .write_png(file);
}

void write_cloud_picture(OutputFile &file, const FrameToWrite &frame) {
  const PointCloud cloud(frame.sensor, frame.channels);
  const CloudPicture picture(cloud);
  const std::scoped_lock alone(drawing_mutex());
  picture.draw(picture_title("point cloud", frame, cloud.distance().frequency)).write_png(file);
}

// Null where there are no distances.
const Channel *cloud_of(const FrameToWrite &frame, const std::set<Format> &formats, Format format) {
  const Channel *distances = distances_of_cloud(frame.channels);
  const bool is_shown = distances && (format != Format::png || distances->preview);
  return formats.contains(format) && is_shown ? distances : nullptr;
}

} // namespace

std::string format_name(Format format) {
  return std::string(format_names.at(static_cast<std::size_t>(format)));
}

Format format_named(std::string_view name) {
  const auto found = std::ranges::find(format_names, name);
  if (found == format_names.end())
    throw std::logic_error("a format of no known name");
  return static_cast<Format>(found - format_names.begin());
}

void require_names_for_files(const std::vector<Sensor> &sensors) {
  for (const Sensor &sensor : sensors)
    if (sensor.name.empty() || sensor.name.front() == '.' || sensor.name.find('/') != std::string::npos)
      throw Error(ExitCode::input,
                  fmt::format("sensor name \"{}\": expected one that can begin a file's name", sensor.name));
}

std::string frame_file_stem(const Sensor &sensor, std::uint32_t frame) {
  return fmt::format("{}_{:04}", sensor.name, frame);
}

std::string picture_title(const std::string &quantity, const FrameToWrite &frame,
                          const std::optional<std::size_t> &frequency) {
  std::string title = quantity;
  if (frequency)
    title += ", " + frequency_text(frame.sensor.modulation_hz[*frequency]);
  return fmt::format("{}, {}, frame {}", title, frame.sensor.name, frame.frame);
}

std::vector<FileToWrite> files_of(const std::shared_ptr<const FrameToWrite> &frame,
                                  const std::set<Format> &formats) {
  const std::string stem = frame_file_stem(frame->sensor, frame->frame);
  const ChannelSet &set = frame->channels;
  std::vector<FileToWrite> files;
  const auto add = [&](const std::string &name, const auto &write) {
    files.push_back({name, [frame, write](OutputFile &file) {
                       throw_if_interrupted();
                       write(file);
                     }});
  };
  if (formats.contains(Format::exr))
    add(stem + ".exr", [&set](OutputFile &file) { write_exr(file, set); });
  if (formats.contains(Format::npz))
    add(stem + ".npz", [&set](OutputFile &file) { write_npz(file, set); });
  if (formats.contains(Format::h5))
    add(stem + ".h5", [&at = *frame](OutputFile &file) {
      write_h5(file, at.channels, {at.sensor, at.frame, at.time_s});
    });
  if (cloud_of(*frame, formats, Format::ply))
    add(stem + ".ply", [&at = *frame](OutputFile &file) {
      write_ply(file, {at.sensor, at.channels}, at.normals, {at.sensor, at.frame, at.time_s});
    });
  if (cloud_of(*frame, formats, Format::png))
    add(stem + ".cloud.png", [&at = *frame](OutputFile &file) { write_cloud_picture(file, at); });
  if (formats.contains(Format::csv))
    add(stem + ".profile.csv",
        [&at = *frame](OutputFile &file) { write_profile_csv(file, at.channels, at.sensor); });
  for (const Channel &channel : set.channels) {
    const std::string name = fmt::format("{}.{}", stem, channel.name());
    if (formats.contains(Format::npy))
      add(name + ".npy", [&set, &channel](OutputFile &file) { write_npy(file, channel, set.resolution); });
    if (formats.contains(Format::png) && channel.preview)
      add(name + ".png", [&at = *frame, &channel](OutputFile &file) { write_preview(file, at, channel); });
  }
  return files;
}

} // namespace pmdsim
