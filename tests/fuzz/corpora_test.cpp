// Every target of tests/fuzz on all inputs of its corpus: those that reach most of the code, and those that
// once failed.

#include "tests/fuzz/targets.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_of(const std::string &target) {
  std::vector<fs::path> files;
  for (const auto &entry : fs::directory_iterator(fs::path(PMDSIM_FUZZ_CORPUS) / target))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<std::uint8_t> bytes_of(const fs::path &file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST_CASE("Fuzzers' inputs give errors in one line or nothing") {
  for (const auto &target : pmdsim::fuzz::targets)
    DYNAMIC_SECTION(target.name) {
      const std::vector<fs::path> files = files_of(target.name);
      CHECK(!files.empty());
      target.run(nullptr, 0);
      for (const fs::path &file : files) {
        INFO(file.filename().string());
        const std::vector<std::uint8_t> bytes = bytes_of(file);
        CHECK(target.run(bytes.data(), bytes.size()) == 0);
      }
    }
}
