#pragma once
// The files of one frame: SENSOR_FRAME.exr, .npz, .h5 and .ply, SENSOR_FRAME.CHANNEL.npy,
// SENSOR_FRAME.CHANNEL.png and SENSOR_FRAME.profile.csv, as far as the command line asks for them.

#include "engine/model/sensor.h"
#include "host/output/files/channel.h"
#include "host/output/files/output_set.h"

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

enum class Format { exr, npz, h5, npy, ply, png, csv };
// As the command line has them, in the order of Format.
inline constexpr std::array<std::string_view, 7> format_names{"exr", "npz", "h5", "npy", "ply", "png", "csv"};
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
  std::shared_ptr<const void> measured; // what the channels and the normals look at
  // Of each pixel's surface, world frame, turned to the lens; empty where they are not known.
  std::span<const glm::vec3> normals{};
  std::span<const std::string> objects{}; // their names, for pictures; outlives the frame
};

// "distance, pmd, frame 0"; of several frequencies "distance, 20 MHz, pmd, frame 0".
std::string picture_title(const std::string &quantity, const FrameToWrite &frame,
                          const std::optional<std::size_t> &frequency);

// They share the frame, which lives as long as one of them does, and can be written on several threads at
// once; each throws Error, interrupted among others.
std::vector<FileToWrite> files_of(const std::shared_ptr<const FrameToWrite> &frame,
                                  const std::set<Format> &formats);

} // namespace pmdsim
