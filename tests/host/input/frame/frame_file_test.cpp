// Frames come back from EXR and HDF5 files as they were written, and no file brings the readers down.

#include "tests/host/input/frame/frame_bits.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

bool has_values(const ReadChannel &channel, const Channel &expected) {
  return std::visit(
      [&](auto values) {
        using Values = std::vector<typename decltype(values)::value_type>;
        const auto *read = std::get_if<Values>(&channel.values);
        return read && read->size() == values.size() &&
               std::memcmp(read->data(), values.data(), values.size_bytes()) == 0;
      },
      expected.values);
}

void check_same(const ReadFrame &read, const ChannelSet &expected) {
  CHECK(read.resolution == expected.resolution);
  REQUIRE(read.channels.size() == expected.channels.size());
  for (std::size_t i = 0; i < read.channels.size(); ++i) { // sorted by name, as in EXR files
    CHECK(read.channels[i].name == expected.channels[i].name());
    CHECK(read.channels[i].unit == expected.channels[i].unit);
    CHECK(has_values(read.channels[i], expected.channels[i]));
  }
}

// Refused as an input, in one line that begins with the file's name, or read.
void check_survives(const std::filesystem::path &path) {
  try {
    const ReadFrame frame = read_frame(path);
    CHECK(!frame.channels.empty());
  } catch (const Error &error) {
    INFO(error.what());
    CHECK(error.code() == ExitCode::input);
    CHECK(std::string(error.what()).starts_with(path.string() + ": "));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
  }
}

} // namespace

TEST_CASE("a frame that ends too early is refused, wherever it ends") {
  const TemporaryFolder folder;
  for (const std::string name : {"frame.exr", "frame.h5"}) {
    const WrittenFrame written({9, 70});
    written.write(folder.path() / name);
    const std::string whole = bytes_of(folder.path() / name);
    // HDF5 rounds the file up to whole pages; where its content ends stands in byte 40 and on.
    std::uint64_t end = whole.size();
    if (name == "frame.h5")
      std::memcpy(&end, whole.data() + 40, sizeof(end));
    REQUIRE(end <= whole.size());
    for (std::size_t bytes = 0; bytes < end; bytes += 1 + bytes / 8) {
      INFO(name << ", the first " << bytes << " of " << whole.size() << " bytes");
      CHECK_THROWS_AS(read_frame(folder.write("part", whole.substr(0, bytes))), Error);
    }
    check_same(read_frame(folder.write("content", whole.substr(0, end))), written.channels());
  }
}

namespace {

// The second of two channels has doubles, too, which wrap at 7.5.
struct FrameOfDoubles {
  FrameOfDoubles() {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(0.0, 7.5);
    for (std::size_t i = 0; i < std::size_t{resolution.x} * resolution.y; ++i) {
      doubles.push_back(any(random));
      floats.push_back(static_cast<float>(doubles.back()));
    }
    doubles[7] = std::numeric_limits<double>::quiet_NaN();
    doubles[8] = std::nextafter(7.5, 0.0);
    floats[7] = std::numeric_limits<float>::quiet_NaN();
    floats[8] = 0.0f;
  }
  void write(const std::filesystem::path &path) const {
    ChannelSet set{resolution,
                   {{"distance_m", "m", std::span(floats), 0}, {"distance_m", "m", std::span(floats), 1}}};
    set.channels[1].unrounded = doubles;
    OutputFile file(path);
    if (path.extension() == ".exr")
      write_exr(file, set);
    else
      write_h5(file, set, {Sensor{}, 0, 0.0});
    file.close();
    file.publish();
  }

  glm::uvec2 resolution{600, 501};
  std::vector<double> doubles;
  std::vector<float> floats;
};

} // namespace

TEST_CASE("doubles come back from HDF5 with all bits, and from EXR with those of two floats") {
  const TemporaryFolder folder;
  const FrameOfDoubles written;
  for (const auto &[name, relative] : {std::pair("frame.h5", 0.0), {"frame.exr", 0x1p-48}}) {
    INFO(name);
    written.write(folder.path() / name);
    const ReadFrame read = read_frame(folder.path() / name);
    REQUIRE(read.channels.size() == 2);
    CHECK(read.channels[0].name == "f0.distance_m");
    CHECK(read.channels[1].name == "f1.distance_m");
    CHECK(read.channels[1].unit == "m");
    CHECK(std::holds_alternative<std::vector<float>>(read.channels[0].values));
    const auto &found = std::get<std::vector<double>>(read.channels[1].values);
    REQUIRE(found.size() == written.doubles.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      REQUIRE((i == 7 ? std::isnan(found[i])
                      : std::abs(found[i] - written.doubles[i]) <= relative * written.doubles[i]));
  }
}

TEST_CASE("what is no frame is refused by the file's name and a reason") {
  const TemporaryFolder folder;
  check_refused(folder.path() / "absent.exr", "no such file");
  check_refused(folder.path(), "is a directory");
  check_refused(folder.write("text.exr", "not one"), "expected a frame as an EXR or an HDF5 file");
  check_refused(folder.write("empty.h5", ""), "expected a frame as an EXR or an HDF5 file");
  check_refused(folder.write("short.h5", std::string("\x89HDF\r\n\x1a\n", 8)), "cannot be read");
  check_refused(folder.write("short.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0", 8)), "cannot be read");
}

TEST_CASE("channels of EXR files have names in UTF-8") {
  const TemporaryFolder folder;
  WrittenFrame({2, 1}).write(folder.path() / "frame.exr");
  const std::string whole = bytes_of(folder.path() / "frame.exr");
  const auto renamed = [&](const std::string &beginning) {
    std::string changed = whole;
    changed.replace(changed.find("object_id"), beginning.size(), beginning);
    return folder.write("renamed.exr", changed);
  };
  for (const std::string name : {"o\xc2\xb2", "o\xe2\x82\xac", "o\xf0\x9f\x93\xb7"})
    CHECK(read_frame(renamed(name)).channels.back().name.starts_with(name));
  for (const std::string name :
       {"o\xb2", "o\xc0\xaf", "o\xc2", "o\xe0\x9f\xbf", "o\xed\xa0\x80", "o\xf4\x90\x80\x80", "o\xff"})
    check_refused(renamed(name), "expected names of channels in UTF-8");
  check_refused(renamed("object_i\xc2"), "expected names of channels in UTF-8");
}

TEST_CASE("EXR files have a limited number of channels") {
  const TemporaryFolder folder;
  const std::vector<float> value(1);
  ChannelSet channels{{1, 1}, {}};
  for (int i = 0; i <= 4096; ++i)
    channels.channels.push_back({fmt::format("channel_{}", i), "", std::span(value)});
  OutputFile file(folder.path() / "many.exr");
  write_exr(file, channels);
  file.close();
  file.publish();
  check_refused(folder.path() / "many.exr", "expected 1 to 4096 channels");
}

TEST_CASE("frames of any bytes are read or refused") {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  for (const std::string name : {"frame.exr", "frame.h5"}) {
    WrittenFrame({9, 70}).write(folder.path() / name);
    const std::string whole = bytes_of(folder.path() / name);
    const std::size_t before_values = name == "frame.exr" ? 450 : 7000;
    for (int i = 0; i < 500; ++i) {
      INFO(name << ", change " << i);
      std::string changed = whole;
      for (int k = 0; k < 1 + i % 4; ++k)
        changed[random() % (i % 2 == 0 ? before_values : changed.size())] = static_cast<char>(random());
      check_survives(folder.write("changed", changed));
    }
  }
}
