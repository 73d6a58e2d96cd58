#include "engine/model/error.h"
#include "engine/model/scene.h"
#include "host/output/files/channel.h"
#include "tests/host/output/file_size_limit.h"
#include "tests/support/temporary_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

constexpr glm::uvec2 exr_resolution{5, 37}; // more than two of ZIP's blocks of 16 lines
constexpr std::size_t pixel_count = exr_resolution.x * exr_resolution.y;

Measurement numbered_measurement() {
  Measurement measurement;
  measurement.resolution = exr_resolution;
  measurement.returns.resize(1);
  float next = 0.1f;
  for (auto *channel : {&measurement.returns[0].amplitude, &measurement.returns[0].phase_rad,
                        &measurement.returns[0].distance_m, &measurement.range_m, &measurement.z_m,
                        &measurement.coverage, &measurement.lit})
    for (std::size_t pixel = 0; pixel < pixel_count; ++pixel)
      channel->push_back(next += 0.7f);
  for (std::uint32_t pixel = 0; pixel < pixel_count; ++pixel) {
    measurement.triangle_id.push_back(70000u + pixel);
    measurement.object_id.push_back(no_id);
  }
  measurement.returns[0].distance_m[7] = std::numeric_limits<float>::quiet_NaN();
  return measurement;
}

template <typename T>
std::vector<T> read_channel(Imf::InputFile &exr, const std::string &name, Imf::PixelType type) {
  const auto window = exr.header().dataWindow();
  const auto columns = static_cast<std::size_t>(window.max.x + 1),
             rows = static_cast<std::size_t>(window.max.y + 1);
  std::vector<T> values(columns * rows);
  Imf::FrameBuffer frame;
  frame.insert(name,
               Imf::Slice(type, reinterpret_cast<char *>(values.data()), sizeof(T), sizeof(T) * columns));
  exr.setFrameBuffer(frame);
  exr.readPixels(0, window.max.y);
  return values;
}

using Bits = std::vector<std::uint32_t>;

// Frames whose channels do not go together: what one has, no other does.
class FrameOfBits {
public:
  explicit FrameOfBits(const glm::uvec2 &resolution) : resolution_(resolution) {}

  // `bits(column, row)` of each pixel.
  void add(const std::string &name, const std::function<std::uint32_t(std::uint32_t, std::uint32_t)> &bits) {
    for (std::uint32_t y = 0; y < resolution_.y; ++y)
      for (std::uint32_t x = 0; x < resolution_.x; ++x)
        bits_[name].push_back(bits(x, y));
  }

  std::size_t bytes() const { return bits_.size() * resolution_.x * resolution_.y * sizeof(std::uint32_t); }

  // Those whose names end with "id" as ids, the others as floats.
  void write(const std::filesystem::path &path) const {
    std::map<std::string, std::vector<float>> floats;
    ChannelSet set{resolution_, {}};
    for (const auto &[name, bits] : bits_)
      if (is_id(name)) {
        set.channels.push_back({name, "", std::span(bits)});
      } else {
        for (const std::uint32_t value : bits)
          floats[name].push_back(std::bit_cast<float>(value));
        set.channels.insert(set.channels.begin(), {name, "", std::span<const float>(floats[name])});
      }
    OutputFile file(path);
    write_exr(file, set);
    file.close();
    file.publish();
  }

  // As OpenEXR's C++ library reads it.
  void check(const std::filesystem::path &path) const {
    Imf::InputFile exr(path.c_str());
    CHECK(exr.isComplete());
    for (const auto &[name, bits] : bits_) {
      INFO(name << ", " << resolution_.x << " x " << resolution_.y);
      const bool same = bits_of(exr, name) == bits; // Catch would print all of them
      CHECK(same);
    }
  }

private:
  static bool is_id(const std::string &name) { return name.ends_with("id"); }

  static Bits bits_of(Imf::InputFile &exr, const std::string &name) {
    if (is_id(name))
      return read_channel<std::uint32_t>(exr, name, Imf::UINT);
    Bits bits;
    for (const float value : read_channel<float>(exr, name, Imf::FLOAT))
      bits.push_back(std::bit_cast<std::uint32_t>(value));
    return bits;
  }

  glm::uvec2 resolution_;
  std::map<std::string, Bits> bits_;
};

// Noise, all kinds of NaN among it; what repeats; and rows that are neither.
FrameOfBits frame_of_everything(const glm::uvec2 &resolution, std::mt19937 &random) {
  FrameOfBits frame(resolution);
  const auto noise = [&](std::uint32_t, std::uint32_t) { return static_cast<std::uint32_t>(random()); };
  frame.add("noise", noise);
  frame.add("noisy_id", noise);
  frame.add("one", [](std::uint32_t, std::uint32_t) { return std::bit_cast<std::uint32_t>(1.0F); });
  frame.add("nothing_id", [](std::uint32_t, std::uint32_t) { return no_id; });
  frame.add("object_id", [](std::uint32_t x, std::uint32_t y) { return (x + y) / 50; });
  frame.add("nan", [](std::uint32_t x, std::uint32_t) { return 0x7fc00000U + x % 2; });
  frame.add("slope", [](std::uint32_t x, std::uint32_t y) {
    return std::bit_cast<std::uint32_t>(2.0F + 1e-4F * static_cast<float>(x * y));
  });
  frame.add("some_rows", [&](std::uint32_t x, std::uint32_t y) { return y % 3 == 0 ? 7U : noise(x, y); });
  frame.add("some_columns", [&](std::uint32_t x, std::uint32_t y) { return x < 60 + y ? 7U : noise(x, y); });
  return frame;
}

std::uintmax_t file_bytes(const FrameOfBits &frame) {
  const pmdsim::test::TemporaryFolder temporary;
  frame.write(temporary.path() / "frame.exr");
  return std::filesystem::file_size(temporary.path() / "frame.exr");
}

} // namespace

TEST_CASE("an EXR file gives back every bit under the channels' names") {
  const pmdsim::test::TemporaryFolder temporary;
  const Measurement measurement = numbered_measurement();
  OutputFile file(temporary.path() / "frame.exr");
  write_exr(file, channels_of(measurement));
  file.close();
  file.publish();

  Imf::InputFile exr(file.path().c_str());
  std::map<std::string, Imf::PixelType> found;
  for (auto channel = exr.header().channels().begin(); channel != exr.header().channels().end(); ++channel)
    found[channel.name()] = channel.channel().type;
  CHECK(found == std::map<std::string, Imf::PixelType>{{"amplitude", Imf::FLOAT},
                                                       {"phase_rad", Imf::FLOAT},
                                                       {"distance_m", Imf::FLOAT},
                                                       {"range_m", Imf::FLOAT},
                                                       {"z_m", Imf::FLOAT},
                                                       {"coverage", Imf::FLOAT},
                                                       {"lit", Imf::FLOAT},
                                                       {"triangle_id", Imf::UINT},
                                                       {"object_id", Imf::UINT}});
  CHECK(read_channel<float>(exr, "amplitude", Imf::FLOAT) == measurement.returns[0].amplitude);
  CHECK(read_channel<float>(exr, "phase_rad", Imf::FLOAT) == measurement.returns[0].phase_rad);
  CHECK(read_channel<float>(exr, "range_m", Imf::FLOAT) == measurement.range_m);
  CHECK(read_channel<float>(exr, "z_m", Imf::FLOAT) == measurement.z_m);
  CHECK(read_channel<float>(exr, "coverage", Imf::FLOAT) == measurement.coverage);
  CHECK(read_channel<float>(exr, "lit", Imf::FLOAT) == measurement.lit);
  CHECK(read_channel<std::uint32_t>(exr, "triangle_id", Imf::UINT) == measurement.triangle_id);
  CHECK(read_channel<std::uint32_t>(exr, "object_id", Imf::UINT) == measurement.object_id);
  const std::vector<float> distance_m = read_channel<float>(exr, "distance_m", Imf::FLOAT);
  CHECK(std::isnan(distance_m[7]));
  CHECK(distance_m[8] == measurement.returns[0].distance_m[8]);
}

TEST_CASE("every bit of any values comes back, whatever the size") {
  const pmdsim::test::TemporaryFolder temporary;
  std::mt19937 random(1);
  // One block and less, a last block of one row, and blocks beyond what one write and one stored piece hold.
  for (const glm::uvec2 resolution :
       {glm::uvec2{1, 1}, {1, 40}, {2, 16}, {3, 17}, {640, 15}, {301, 50}, {2500, 70}, {20000, 3}}) {
    const FrameOfBits frame = frame_of_everything(resolution, random);
    frame.write(temporary.path() / "frame.exr");
    frame.check(temporary.path() / "frame.exr");
  }
}

TEST_CASE("rows that repeat hardly take room, and noise no more than it has") {
  constexpr glm::uvec2 resolution{640, 160};
  constexpr std::size_t header_bytes = 1000;
  std::mt19937 random(2);
  FrameOfBits noise(resolution), repeats(resolution), both(resolution);
  const auto random_bits = [&](std::uint32_t, std::uint32_t) { return static_cast<std::uint32_t>(random()); };
  const auto squares = [](std::uint32_t x, std::uint32_t y) { return x / 40 + y / 40; };
  noise.add("noise", random_bits);
  repeats.add("object_id", squares);
  both.add("noise", random_bits);
  both.add("object_id", squares);
  CHECK(file_bytes(noise) <= noise.bytes() + header_bytes);
  CHECK(file_bytes(repeats) < repeats.bytes() / 25);
  CHECK(file_bytes(both) < noise.bytes() + repeats.bytes() / 10);
}

TEST_CASE("a disk that is full before a frame's end is an error") {
  const pmdsim::test::TemporaryFolder temporary;
  std::mt19937 random(3);
  const FrameOfBits frame = frame_of_everything({640, 100}, random);
  const std::uintmax_t whole = file_bytes(frame);
  for (const std::uintmax_t bytes : {std::uintmax_t{100}, whole / 2, whole - 1}) {
    const FileSizeLimit limit(bytes);
    CHECK_THROWS_WITH(frame.write(temporary.path() / "frame.exr"),
                      (temporary.path() / "frame.exr").string() + ": cannot be written: File too large");
  }
  CHECK(std::filesystem::is_empty(temporary.path()));
}
