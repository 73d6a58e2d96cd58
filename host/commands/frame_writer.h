#pragma once
// The files of one frame: SENSOR_FRAME.exr, SENSOR_FRAME.CHANNEL.npy, SENSOR_FRAME.CHANNEL.png and
// SENSOR_FRAME.profile.csv, as far as the command line asks for them.

#include "engine/sensor.h"
#include "host/options.h"
#include "host/output/channel.h"
#include "host/output/output_set.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace pmdsim {

// Throws Error (input) where the sensor's name cannot be part of a file's name; to be asked before measuring.
void require_name_for_files(const Sensor &sensor);

// "pmd_0000". Throws as require_name_for_files().
std::string frame_file_stem(const Sensor &sensor, std::uint32_t frame);

struct FrameToWrite {
  const Sensor &sensor;
  std::uint32_t frame;
  const ChannelSet &channels;
  std::vector<std::string> previewed; // names of the channels that get a picture
};

// Adds the files to `outputs`. Throws Error, interrupted among others.
void write_frame(OutputSet &outputs, const FrameToWrite &frame, const std::set<Format> &formats);

} // namespace pmdsim
