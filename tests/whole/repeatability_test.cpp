// The same bits, whatever the run, the height of the strips and the number of threads.

#include "tests/comparison/frame_bytes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

std::string bytes_in_strips(const RepeatabilityFrame &frame, std::uint32_t max_strip_samples = 0) {
  Simulator simulator = make_simulator(keep_everything(max_strip_samples));
  return bytes_of(measure(simulator, frame));
}

std::string bytes_with_threads(const std::string &name, unsigned threads) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("pmdsim_frame_{}_threads.bin", threads);
  std::filesystem::remove(file);
  const std::string command =
      fmt::format("LP_NUM_THREADS={} '{}' {} '{}'", threads, WRITE_FRAME_BYTES, name, file.string());
  REQUIRE(std::system(command.c_str()) == 0);
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  std::filesystem::remove(file);
  return bytes.str();
}

void check_strips(const std::string &name, const RepeatabilityFrame &frame,
                  const std::vector<std::uint32_t> &heights) {
  const std::uint32_t samples_per_row =
      frame.sensor.resolution.x * frame.sensor.samples * frame.sensor.samples;
  const std::string whole = bytes_in_strips(frame);
  for (const std::uint32_t rows : heights) {
    INFO(name << ", strips of " << rows << " pixel rows");
    CHECK((bytes_in_strips(frame, rows * samples_per_row) == whole));
  }
  INFO(name << ", strips of 7 rows and a bit");
  CHECK((bytes_in_strips(frame, 7 * samples_per_row + 333) == whole));
}

const std::string full_frame = "shadows_brown_tilted_filled_square";
// One of each way to a frame: records of depth, points with shadows and tones, fewer diodes.
const std::vector<std::string> some_frames{"pinhole", full_frame, "automatic"};

void check_two_simulators(const std::vector<std::string> &names) {
  for (const std::string &name : names) {
    INFO(name);
    const RepeatabilityFrame frame = repeatability_frame(name);
    Simulator simulator = make_simulator(keep_everything());
    const Measurement first = measure(simulator, frame);
    REQUIRE(std::count_if(first.returns.back().amplitude.begin(), first.returns.back().amplitude.end(),
                          [](float a) { return a > 0; }) > 10000);
    CHECK((bytes_of(simulator.measure()) == bytes_of(first)));
    CHECK((bytes_in_strips(frame) == bytes_of(first)));
  }
}

void check_used_simulator(const std::vector<std::string> &names) {
  Simulator used = make_simulator(keep_everything());
  for (const std::string &name : names)
    for (const bool again : {false, true}) { // what was there before, another frame's or its own
      INFO(name << (again ? ", prepared again" : ""));
      const RepeatabilityFrame frame = repeatability_frame(name);
      CHECK((bytes_of(measure(used, frame)) == bytes_in_strips(frame)));
    }
}

void check_all_strips(const std::vector<std::string> &names, const std::vector<std::uint32_t> &heights) {
  for (const std::string &name : names)
    check_strips(name, repeatability_frame(name), heights);
}

void check_threads(const std::vector<std::string> &names) {
  for (const std::string &name : names) {
    INFO(name);
    const std::string whole = bytes_in_strips(repeatability_frame(name));
    REQUIRE(whole.size() > 256 * 192 * 4);
    CHECK((bytes_with_threads(name, 1) == whole));
    CHECK((bytes_with_threads(name, 2) == whole));
  }
}

} // namespace

TEST_CASE("hidden triangles, so many that samples fetch their planes for themselves, change no bit") {
  const auto frame_of = [](int hidden) {
    SceneBuilder builder;
    builder.add_triangle({-3, -2, 1.5}, {-3, 4, 2.5}, {4, 0, 2});
    builder.add_wall({4.0});
    for (int i = 0; i < hidden; ++i)
      builder.add_triangle({0.01 * i, 0, 5}, {0.01 * i, 0.5, 5}, {0.01 * i + 0.1, 0, 5});
    Sensor sensor;
    sensor.resolution = {64, 48};
    sensor.pixel_pitch_m = glm::dvec2(4e-4);
    sensor.focal_length_m = 0.02;
    Simulator simulator = make_simulator(keep_everything());
    simulator.prepare(builder.scene(), sensor, {diode_beside_lens(sensor, diode_at({0.1, 0, 0}))},
                      Backscatter::lambert);
    return bytes_of(simulator.measure());
  };
  CHECK((frame_of(0) == frame_of(300)));
}

TEST_CASE("two measurements and two simulators give the same bits, some frames", "[smoke]") {
  check_two_simulators(some_frames);
}

TEST_CASE("two measurements and two simulators give the same bits, all frames", "[long]") {
  check_two_simulators(repeatability_frames());
}

TEST_CASE("a simulator that has measured another frame gives the same bits, two frames") {
  check_used_simulator({"pinhole", full_frame});
}

TEST_CASE("a simulator that has measured other frames gives the same bits, all frames", "[long]") {
  check_used_simulator(repeatability_frames());
}

TEST_CASE("strips give the same bits, one frame") { check_all_strips({full_frame}, {191}); }

TEST_CASE("strips of any height give the same bits, all frames", "[long]") {
  check_all_strips(repeatability_frames(), {1, 7, 191});
}

TEST_CASE("one thread and two give the same bits, one frame") { check_threads({full_frame}); }

TEST_CASE("one thread and two give the same bits, all frames", "[long]") {
  check_threads(repeatability_frames());
}
