#pragma once
// One HDF5 file a frame.

#include "engine/model/sensor.h"
#include "host/output/files/channel.h"

#include <cstdint>

namespace pmdsim {

// Which frame it is.
struct FrameLabel {
  const Sensor &sensor; // where it was when the frame began
  std::uint32_t frame;
  double time_s; // when it began
};

// Datasets (rows, columns) under the channels' names, float32 or uint32, little-endian, not compressed, in
// chunks of whole rows; with the attributes `units` ("" for none), `long_name` and, of floats, `_FillValue`
// NaN; with the dimension scales `row` and `column`. Attributes of the file: program, version, sensor, frame,
// time_s, modulation_hz, ambiguity_m, and camera, the JSON of a manifest (manifest.h, camera_json()).
//
// So it is a netCDF-4 file, too. The same frame gives the same bytes. It is built in memory, one file at a
// time, and may be called from several threads at once. Throws Error (output).
void write_h5(OutputFile &file, const ChannelSet &channels, const FrameLabel &label);

} // namespace pmdsim
