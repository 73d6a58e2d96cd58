#pragma once
// A frame as a file of EXR or HDF5, and files that are no frames.

#include "engine/model/error.h"
#include "engine/model/scene.h"
#include "host/input/frame/frame_file.h"
#include "host/output/files/channel.h"
#include "host/output/files/h5_writer.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace pmdsim::test {

// Every kind of bits, in channels of every type that frames have.
struct WrittenFrame {
  explicit WrittenFrame(const glm::uvec2 &size) : resolution(size) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < std::size_t{size.x} * size.y; ++i) {
      distances.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
      ids.push_back(i % 3 == 0 ? no_id : static_cast<std::uint32_t>(i / 7));
    }
  }
  ChannelSet channels() const {
    return {resolution,
            {{"distance_m", "m", std::span(distances), 0},
             {"distance_m", "m", std::span(distances), 1},
             {"tap2", "W/(m² sr)", std::span(distances), 1},
             {"object_id", "", std::span(ids)}}};
  }
  void write(const std::filesystem::path &path) const {
    OutputFile file(path);
    if (path.extension() == ".exr")
      write_exr(file, channels());
    else
      write_h5(file, channels(), {Sensor{}, 0, 0.0});
    file.close();
    file.publish();
  }

  glm::uvec2 resolution;
  std::vector<float> distances;
  std::vector<std::uint32_t> ids;
};

inline std::string bytes_of(const std::filesystem::path &path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void check_refused(const std::filesystem::path &path, const std::string &reason) {
  CHECK_THROWS_WITH(read_frame(path), Catch::StartsWith(path.string()) && Catch::Contains(reason));
}

} // namespace pmdsim::test
