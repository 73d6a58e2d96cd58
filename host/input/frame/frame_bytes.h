#pragma once
// What the readers of EXR and HDF5 share: the bytes of a file, and what is wrong with them.

#include "engine/model/error.h"
#include "host/input/frame/frame_file.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace pmdsim {

struct FrameBytes {
  const std::filesystem::path &file;
  std::string content;
};

// "FILE: MESSAGE", (input).
Error frame_error(const FrameBytes &frame, std::string_view message);

// Takes the size of a frame, whose channels have `pixel_bytes` a pixel together. Throws Error where it is
// none, or where `stored_bytes` of a file cannot hold so many values, compressed or not.
glm::uvec2 checked_resolution(const FrameBytes &frame, std::uint64_t columns, std::uint64_t rows,
                              std::uint64_t pixel_bytes, std::uint64_t stored_bytes);

// What `deform` adds to the channels of engine/model/channels.h.
inline constexpr std::string_view deformation_name = "deformation_mm";

// "m" of "f1.distance_m"; "" where none is known.
std::string unit_of(std::string_view channel_name);

ReadFrame read_exr(const FrameBytes &frame);
ReadFrame read_h5(const FrameBytes &frame);

} // namespace pmdsim
