#pragma once
// A sequence of small frames, and what must hold of its folder whenever a run ends.

#include "tests/faults/faulty_runs.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <set>

namespace pmdsim::test {

struct Sequence {
  Workspace work;
  std::string setup;

  explicit Sequence(int frames) {
    work.write("wall.gltf", wall_gltf());
    setup = work.write("setup.json",
                       with(small_setup(), "\"sensors\":",
                            fmt::format(R"("frames": {{"rate_hz": 10, "count": {}}}, "sensors":)", frames)));
  }

  std::vector<std::string> arguments(const std::string &out,
                                     const std::vector<std::string> &more = {}) const {
    std::vector<std::string> all{"render", setup, "--device", "reference", "--format", "npy,exr", "-o", out};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

// How many frames have a record. Each of them has its files, and files of no other frame are there.
inline std::size_t check_whole(const std::filesystem::path &folder) {
  std::set<std::string> recorded, frames;
  for (const auto &[name, bytes] : files_below(folder)) {
    CHECK_FALSE(name.ends_with(".partial"));
    if (name.ends_with(".record.json"))
      recorded.insert(name.substr(0, 4));
    else if (name.starts_with("pmd_"))
      frames.insert(name.substr(4, 4));
  }
  CHECK(frames == recorded);
  return recorded.size();
}

} // namespace pmdsim::test
