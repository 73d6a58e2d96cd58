#pragma once
// A simulator of the C interface, and a small setup in a folder of its own.

#include "host/library/pmdsim.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <vector>

namespace pmdsim::test {

// What the last call that failed told.
inline std::string told() { return pmdsim_error_message(); }

struct Loaded {
  Workspace work;
  std::string file;
  pmdsim_simulator *simulator = nullptr;

  // With files of these names and contents beside the setup.
  explicit Loaded(const std::string &setup = small_setup(), const char *device = nullptr,
                  const std::map<std::string, std::string> &files = {}) {
    work.write("wall.gltf", wall_gltf());
    for (const auto &[name, content] : files)
      work.write(name, content);
    file = work.write("setup.json", setup);
    REQUIRE(pmdsim_simulator_create(device, &simulator) == PMDSIM_OK);
    REQUIRE(pmdsim_simulator_load(simulator, file.c_str()) == PMDSIM_OK);
  }
  ~Loaded() { pmdsim_simulator_destroy(simulator); }
  Loaded(const Loaded &) = delete;
  Loaded &operator=(const Loaded &) = delete;

  pmdsim_frame *render(const pmdsim_render_options *options = nullptr) const {
    pmdsim_frame *frame = nullptr;
    INFO(told());
    REQUIRE(pmdsim_render(simulator, 0, 0, options, &frame) == PMDSIM_OK);
    return frame;
  }
};

inline std::vector<float> floats_of(const pmdsim_frame *frame, const std::string &name) {
  pmdsim_channel channel{};
  channel.struct_size = sizeof(channel);
  REQUIRE(pmdsim_frame_find(frame, name.c_str(), &channel) == PMDSIM_OK);
  REQUIRE(channel.type == PMDSIM_FLOAT32);
  const auto *values = static_cast<const float *>(channel.values);
  return {values, values + std::size_t{channel.rows} * channel.columns};
}

// What a rendered distance in the middle of the wall is.
inline float middle(const pmdsim_frame *frame, const std::string &name = "distance_m") {
  const std::vector<float> values = floats_of(frame, name);
  return values[values.size() / 2 + 4];
}

} // namespace pmdsim::test
