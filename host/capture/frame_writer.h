#pragma once
// The files of one frame: SENSOR_FRAME.exr, .npz and .h5, SENSOR_FRAME.CHANNEL.npy, SENSOR_FRAME.CHANNEL.png
// and SENSOR_FRAME.profile.csv, as far as the command line asks for them.

#include "engine/model/sensor.h"
#include "host/output/files/channel.h"
#include "host/output/files/output_set.h"

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

enum class Format { exr, npz, h5, npy, png, csv };
// As the command line has them, in the order of Format.
inline constexpr std::array<std::string_view, 6> format_names{"exr", "npz", "h5", "npy", "png", "csv"};
std::string format_name(Format format);
// Of one of these names.
Format format_named(std::string_view name);

// Throws Error (input) where a sensor's name cannot be part of a file's name; to be asked before measuring.
void require_names_for_files(const std::vector<Sensor> &sensors);

// "pmd_0000".
std::string frame_file_stem(const Sensor &sensor, std::uint32_t frame);

struct FrameToWrite {
  Sensor sensor;
  std::uint32_t frame;
  double time_s; // when it began
  ChannelSet channels;
  std::shared_ptr<const void> measured; // what the channels look at
};

// "distance, pmd, frame 0"; of several frequencies "distance, 20 MHz, pmd, frame 0".
std::string picture_title(const std::string &quantity, const FrameToWrite &frame,
                          const std::optional<std::size_t> &frequency);

// They share the frame, which lives as long as one of them does, and can be written on several threads at
// once; each throws Error, interrupted among others.
std::vector<FileToWrite> files_of(const std::shared_ptr<const FrameToWrite> &frame,
                                  const std::set<Format> &formats);

} // namespace pmdsim
