#pragma once
// The image that is to be corrected, from whatever file people have.

#include "engine/correction/correction.h"
#include "host/correction/image_values.h"

#include <filesystem>
#include <optional>
#include <string>

namespace pmdsim {

// What is said of the image.
struct ImageRequest {
  std::filesystem::path file;         // or a directory that `render` has left
  std::optional<std::string> channel; // of a file of several: its name, with or without that of a frequency
  std::optional<Quantity> quantity;   // nothing: by the name
  std::optional<double> unit;         // metres or radians of 1; nothing: by the name
  std::optional<double> invalid;      // a number of the file that says: not measured, beside those that do
  std::size_t frequency = 0;
  // What tells the turn, the first that is there; nothing of it: the image.
  std::filesystem::path guess; // an image of ranges, or empty
  double unwrap_range_m = 0.0; // the distances of all frequencies tell the turn, within that; 0: they do not
  std::optional<double> least_range_m; // ranges lie between this and an ambiguity range more
};

struct MeasuredFile {
  MeasuredImage image{};
  std::string source{}; // "distance_m of out/room/pmd_0000.exr"
  Meaning meaning{};
  std::vector<double> values{}; // metres or radians, by its meaning; NaN where nothing was measured
  std::string turns{};          // what tells the turn of a phase; empty: the least range does
  // Stray distances beyond the ambiguity range, of which whole ambiguity ranges are taken off.
  std::size_t beyond_ambiguity = 0;
  std::vector<Warning> warnings{}; // that the values seem to be something else
  // Ground truth that lies in the same file, else empty.
  std::vector<double> range_m{}, lit{};
};

// `sensor` as it was at the image's frame. Throws Error: (usage) where the image has not what is said of it,
// (input) that names the file.
MeasuredFile read_measured(const ImageRequest &request, const Sensor &sensor, std::uint32_t frame);

// An image of ranges, of the sensor's size: the channel range_m, or the only image of the file. `lit` stays
// empty where the file has no such channel.
struct TruthFile {
  std::vector<double> range_m, lit{};
};
TruthFile read_truth(const std::filesystem::path &file, const Sensor &sensor);

} // namespace pmdsim
