// The same bits, whatever the run, the height of the strips and the number of threads.

#include "tests/gpu_against_reference/frame_bytes.h"
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

Measurement repeatability_frame(std::uint32_t max_strip_samples = 0) {
  Simulator simulator =
      make_simulator({.device = {}, .max_strip_samples = max_strip_samples, .keep_sample_tags = true});
  prepare_repeatability_frame(simulator);
  return simulator.measure();
}

std::string bytes_with_threads(unsigned threads) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("pmdsim_frame_{}_threads.bin", threads);
  std::filesystem::remove(file);
  const std::string command =
      fmt::format("LP_NUM_THREADS={} '{}' '{}'", threads, WRITE_FRAME_BYTES, file.string());
  REQUIRE(std::system(command.c_str()) == 0);
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  std::filesystem::remove(file);
  return bytes.str();
}

} // namespace

TEST_CASE("two measurements and two simulators give the same bits") {
  Simulator simulator = make_simulator({.device = {}, .keep_sample_tags = true});
  prepare_repeatability_frame(simulator);
  const Measurement first = simulator.measure();
  REQUIRE(std::count_if(first.returns[0].amplitude.begin(), first.returns[0].amplitude.end(),
                        [](float a) { return a > 0; }) > 10000);
  CHECK((bytes_of(simulator.measure()) == bytes_of(first)));
  CHECK((bytes_of(repeatability_frame()) == bytes_of(first)));
}

TEST_CASE("strips of any height give the same bits") {
  const std::uint32_t samples_per_row = 256 * 4;
  const std::string whole = bytes_of(repeatability_frame());
  for (const std::uint32_t rows : {1u, 7u, 64u, 191u}) {
    INFO("strips of " << rows << " pixel rows");
    CHECK((bytes_of(repeatability_frame(rows * samples_per_row)) == whole));
  }
  CHECK((bytes_of(repeatability_frame(7 * samples_per_row + 333)) == whole));
}

TEST_CASE("one thread and two give the same bits") {
  const std::string whole = bytes_of(repeatability_frame());
  REQUIRE(whole.size() > 256 * 192 * 4);
  CHECK((bytes_with_threads(1) == whole));
  CHECK((bytes_with_threads(2) == whole));
}
