#include "host/input/frame/frame_file.h"

#include "engine/correction/corrected_channels.h"
#include "engine/model/channel_names.h"
#include "host/input/file/input_file.h"
#include "host/input/file/memory_request.h"
#include "host/input/frame/frame_bytes.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace pmdsim {
namespace {

constexpr std::size_t max_frame_bytes = std::size_t{1} << 32;
constexpr std::string_view exr_magic("\x76\x2f\x31\x01", 4);
constexpr std::string_view h5_magic("\x89HDF\r\n\x1a\n", 8);
// Deflate makes at most 1032 bytes of one.
constexpr std::uint64_t most_of_a_byte = 1032;

} // namespace

Error frame_error(const FrameBytes &frame, std::string_view message) {
  return input_error(Place{frame.file}, message);
}

glm::uvec2 checked_resolution(const FrameBytes &frame, std::uint64_t columns, std::uint64_t rows,
                              std::uint64_t pixel_bytes, std::uint64_t stored_bytes) {
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  if (columns < 1 || columns > most || rows < 1 || rows > most)
    throw frame_error(frame, fmt::format("{} x {} pixels, expected 1 to {} a side", columns, rows, most));
  if (columns * rows > stored_bytes * most_of_a_byte / pixel_bytes)
    throw frame_error(frame, fmt::format("expected the values of {} x {} pixels, found {} bytes", columns,
                                         rows, stored_bytes));
  require_memory(columns * rows * pixel_bytes, Place{frame.file},
                 fmt::format("{} x {} pixels", columns, rows));
  return {columns, rows};
}

std::string unit_of(std::string_view channel_name) {
  if (channel_name.ends_with(deformation_name))
    return "mm";
  const ChannelRow *row = channel_named(channel_name).row;
  if (row)
    return std::string(row->unit);
  const auto corrected = std::ranges::find(corrected_channel_rows, channel_name, &CorrectedChannelRow::name);
  return corrected != corrected_channel_rows.end() ? std::string(corrected->unit) : "";
}

ReadFrame read_frame(const std::filesystem::path &file) {
  const FrameBytes frame{file, read_regular_file(file, max_frame_bytes, Place{file})};
  if (frame.content.starts_with(exr_magic))
    return read_exr(frame);
  if (frame.content.starts_with(h5_magic))
    return read_h5(frame);
  throw frame_error(frame, "expected a frame as an EXR or an HDF5 file");
}

} // namespace pmdsim
