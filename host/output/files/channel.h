#pragma once
// The channels of a frame as files name them (docs/outputs.md, "Channels"), and the files of their values.

#include "engine/model/channels.h"
#include "host/output/files/output_file.h"

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pmdsim {

// "distance_m", of the frequency 1 of several "f1.distance_m".
std::string channel_name(const std::string &quantity, const std::optional<std::size_t> &frequency);

// A view: row-major, row 0 at the top, rows * columns values that outlive it. Floats hold NaN where nothing
// was measured, ids no_id.
struct Channel {
  std::string quantity; // "distance_m"
  std::string unit;     // "" for ids and ratios
  std::variant<std::span<const float>, std::span<const std::uint32_t>> values;
  std::optional<std::size_t> frequency = std::nullopt; // index of the one that it belongs to, of several
  std::optional<Preview> preview = std::nullopt;       // nothing: no picture is made of it
  std::string about{};                                 // what it is, in a line
  // The same before they were rounded to float, where files shall have that; else empty. Of a channel that
  // was read there may be these alone.
  std::span<const double> unrounded{};

  std::string name() const { return channel_name(quantity, frequency); }
};

// The values as files have them that know double.
using ChannelValues =
    std::variant<std::span<const float>, std::span<const std::uint32_t>, std::span<const double>>;
ChannelValues written_values(const Channel &channel);

// Channels of one size.
struct ChannelSet {
  glm::uvec2 resolution{0, 0}; // columns, rows
  std::vector<Channel> channels;
};

// Channel::frequency of what belongs to the frequency `index` of `count`.
std::optional<std::size_t> frequency_of(std::size_t index, std::size_t count);

// The rows of engine/model/channels.h, of every frequency and tap, but for those that are empty. Views into
// `measurement`. Unrounded where it has that, too.
ChannelSet channels_of(const Measurement &measurement);

// One OpenEXR file a frame: scan lines, ZIP, floats as FLOAT and ids as UINT, channels under their own names.
// EXR knows no double: beside a channel that is unrounded, too, stands another FLOAT of what rounding took
// (rest_name() of engine/model/channel_names.h), so that both together are the double to 2^-48 of it. Reads
// the channels where they lie; memory beyond them is that of rests and of a few dozen scan lines. May be
// called from several threads at once. Throws Error (output).
void write_exr(OutputFile &file, const ChannelSet &channels);

// NumPy's array file, version 1.0: shape (rows, columns), little-endian, C order, '<f4', '<u4' or '<f8'; the
// data start at a multiple of 64 bytes, so that they can be mapped. Source: NumPy's documentation,
// numpy.lib.format. Throws Error (output).
void write_npy(OutputFile &file, const Channel &channel, const glm::uvec2 &resolution);
// What such a file has before its data.
std::string npy_header(const Channel &channel, const glm::uvec2 &resolution);

// All channels in one file as numpy.savez() writes it and numpy.load() reads it: a ZIP archive of
// CHANNEL.npy, stored as they are, without times. May be called from several threads at once. Throws Error
// (output).
void write_npz(OutputFile &file, const ChannelSet &channels);

} // namespace pmdsim
