#pragma once
// Frames that the program wrote, read again: the channels of an EXR or an HDF5 file. Files are untrusted.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pmdsim {

struct ReadChannel {
  std::string name; // in UTF-8: "distance_m", of several frequencies "f1.distance_m"
  std::string unit; // by the name; "" where there is none, or none is known
  // Row-major, row 0 at the top, rows * columns; every bit as in the file, but
  // for doubles that an EXR file has as two floats.
  std::variant<std::vector<float>, std::vector<std::uint32_t>, std::vector<double>> values;
};

struct ReadFrame {
  glm::uvec2 resolution{0, 0}; // columns, rows
  // Of EXR sorted by name, of HDF5 in the order of for_each_channel() in engine/model/channels.h.
  std::vector<ReadChannel> channels{};
};

// The endings of the files that read_frame() reads, as the program names them; of several files of a frame
// the first is the one to read.
inline constexpr std::array<std::string_view, 2> frame_file_endings{".exr", ".h5"};

// A file of at most 4 GiB, which its first bytes tell to be an EXR or an HDF5 file. EXR: one part of scan
// lines, FLOAT and UINT, without compression or with RLE, ZIPS or ZIP; a channel and its rest
// (engine/model/channel_names.h) become one of doubles. HDF5: the two-dimensional datasets of the root group
// that have the names of channels, float32, float64 and uint32, all of one size, without compression
// or with gzip; nothing else is looked at. Nothing is allocated for values that the file has no bytes for.
// May be called from several threads at once. Throws Error (input) that names the file.
ReadFrame read_frame(const std::filesystem::path &file);

} // namespace pmdsim
