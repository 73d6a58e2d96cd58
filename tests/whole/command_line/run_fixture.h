#pragma once
// Runs of many small frames, and what their folders hold.

#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/stat.h>
#include <tuple>
#include <vector>

namespace pmdsim::test {

inline std::string bytes_in(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Inode, time and size: another one once a file has been written again.
using FileState = std::tuple<ino_t, std::int64_t, std::int64_t, off_t>;

class ManyFrames {
public:
  // Of two sensors. `samples` squared a pixel make frames slow on the reference.
  explicit ManyFrames(int frames, int samples = 1) : samples_(samples) {
    work.write("wall.gltf", wall_gltf());
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(small_setup());
    json["frames"] = {{"rate_hz", 10}, {"count", frames}};
    json["sensors"].push_back(json["sensors"][0]);
    json["sensors"][1]["name"] = "second";
    json["sensors"][1]["modulation_hz"] = {30e6, 50e6};
    setup = work.write("setup.json", json.dump());
  }

  Workspace work;
  std::string setup;

  std::vector<std::string> arguments(const std::string &folder, const std::vector<std::string> &more = {},
                                     const std::string &command = "render") const {
    std::vector<std::string> all{command,       setup, "--device",    "reference", "--format",
                                 "exr,npy,csv", "-o",  work / folder, "--samples", std::to_string(samples_)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Run run(const std::string &folder, const std::vector<std::string> &more = {},
          const std::string &command = "render") const {
    return run_pmdsim(arguments(folder, more, command));
  }
  void run_well(const std::string &folder, const std::vector<std::string> &more = {},
                const std::string &command = "render") const {
    const Run ended = run(folder, more, command);
    INFO(ended.errors);
    REQUIRE(ended.exit_code == 0);
  }

  std::string record(const std::string &folder, int frame) const {
    return work / fmt::format("{}/{:04}.record.json", folder, frame);
  }
  std::size_t frames_in_manifest(const std::string &folder) const {
    return nlohmann::json::parse(bytes_in(work / (folder + "/manifest.json"))).at("frames").size();
  }

  // The files of all frames that have a record.
  std::map<std::string, FileState> whole_files(const std::string &folder) const {
    std::map<std::string, FileState> states;
    const auto note = [&](const std::string &name) {
      struct stat status {};
      if (::stat((work / (folder + "/" + name)).c_str(), &status) == 0)
        states[name] = {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size};
    };
    for (const std::string &name : work.files(folder))
      if (name.ends_with(".record.json")) {
        note(name);
        const auto record = nlohmann::json::parse(bytes_in(work / (folder + "/" + name)));
        for (const auto &sensor : record.at("sensors"))
          for (const std::string output : sensor.at("manifest").at("outputs"))
            note(output);
      }
    return states;
  }

  // The same files with the same bytes, and records that differ in times and the like at most.
  void check_same(const std::string &folder, const std::string &expected) const {
    REQUIRE(work.files(folder) == work.files(expected));
    std::size_t differing = 0;
    for (const std::string &name : work.files(expected))
      if (name != "run.json" && text_of(folder, name) != text_of(expected, name)) {
        UNSCOPED_INFO(name);
        ++differing;
      }
    CHECK(differing == 0);
  }

private:
  std::string text_of(const std::string &folder, const std::string &name) const {
    const std::string text = bytes_in(work / (folder + "/" + name));
    if (!name.ends_with(".record.json"))
      return text;
    auto record = nlohmann::ordered_json::parse(text);
    record.erase("host");
    for (auto &sensor : record.at("sensors"))
      for (const char *key : {"frame_ms", "passes_ms", "check_ms"})
        sensor.erase(key);
    return record.dump();
  }

  int samples_;
};

} // namespace pmdsim::test
