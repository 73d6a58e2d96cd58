// Images of numbers as people have them, and files that are none.

#include "host/input/array/image_array.h"

#include "engine/model/error.h"
#include "host/output/files/channel.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <png.h>
#include <random>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

const auto any_name = [](std::string_view) { return true; };

// An NPY file of version 1 with this header.
std::string npy(const std::string &dictionary, const std::string &data) {
  std::string header = dictionary + '\n';
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size() & 0xff);
  file += static_cast<char>(header.size() >> 8);
  return file + header + data;
}

std::string header_of(const std::string &type, const std::string &shape, bool fortran = false) {
  return "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': " + shape + ", }";
}

template <class Value>
std::string bytes_of(const std::vector<Value> &values, bool swapped = false) {
  std::string bytes;
  for (const Value &value : values) {
    std::array<char, sizeof(Value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(Value));
    bytes += swapped ? std::string(raw.rbegin(), raw.rend()) : std::string(raw.begin(), raw.end());
  }
  return bytes;
}

class ArrayFile {
public:
  ImageArray read(const std::string &bytes) const {
    return read_image_arrays(folder_.write("image", bytes), any_name).arrays.at(0);
  }
  std::string refusal(const std::string &bytes) const {
    try {
      read(bytes);
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::input);
      CHECK(std::string(error.what()).find("image") != std::string::npos);
      return error.what();
    }
    return "none";
  }

private:
  test::TemporaryFolder folder_;
};

using Catch::Matchers::Contains;

} // namespace

TEST_CASE("NPY: floats and integers, either order of bytes and of axes", "[smoke]") {
  const ArrayFile file;
  const std::vector<double> doubles{1.5, -2.0, 1e-300, 4.0, 5.0, 6.0};
  const std::vector<float> floats{1.5f, -2.0f, 0.25f, 4.0f, 5.0f, 6.0f};
  const std::vector<std::uint16_t> millimetres{0, 1, 256, 65535, 5, 6};
  CHECK(file.read(npy(header_of("<f8", "(2, 3)"), bytes_of(doubles))).values == doubles);
  CHECK(file.read(npy(header_of(">f8", "(2, 3)"), bytes_of(doubles, true))).values == doubles);
  CHECK(file.read(npy(header_of(">f4", "(2, 3)"), bytes_of(floats, true))).values ==
        std::vector<double>(floats.begin(), floats.end()));
  const ImageArray whole = file.read(npy(header_of(">u2", "(2, 3)"), bytes_of(millimetres, true)));
  CHECK(whole.values == std::vector<double>(millimetres.begin(), millimetres.end()));
  CHECK(whole.whole_numbers);
  CHECK(whole.resolution == glm::uvec2(3, 2));
  CHECK(file.read(npy(header_of("<f8", "(2, 3)", true), bytes_of(doubles))).values ==
        std::vector<double>{1.5, 1e-300, 5.0, -2.0, 4.0, 6.0});
}

TEST_CASE("what render writes comes back: NPY, NPZ, EXR, HDF5 by its names") {
  const test::TemporaryFolder folder;
  const std::vector<float> distance_m{1.0f, 2.5f, std::nanf(""), 4.0f}, range_m{5.0f, 6.0f, 7.0f, 8.0f};
  const ChannelSet set{{2, 2},
                       {{"distance_m", "m", std::span(distance_m)}, {"range_m", "m", std::span(range_m)}}};
  const auto written = [&](const char *name, const std::function<void(OutputFile &)> &write) {
    OutputFile file(folder.path() / name);
    write(file);
    file.close();
    file.publish();
    return folder.path() / name;
  };
  const auto only_range = [](std::string_view name) { return name == "range_m"; };
  for (const auto &path : {written("a.npz", [&](OutputFile &file) { write_npz(file, set); }),
                           written("a.exr", [&](OutputFile &file) { write_exr(file, set); })}) {
    const ImageArrays read = read_image_arrays(path, only_range);
    CHECK(read.names == std::vector<std::string>{"distance_m", "range_m"});
    REQUIRE(read.arrays.size() == 1);
    CHECK(read.arrays[0].values == std::vector<double>{5, 6, 7, 8});
  }
  const auto npy_path = written("a.npy", [&](OutputFile &file) { write_npy(file, set.channels[0], {2, 2}); });
  const ImageArray array = read_image_arrays(npy_path, any_name).arrays.at(0);
  CHECK(array.values[1] == 2.5);
  CHECK(std::isnan(array.values[2]));
}

TEST_CASE("rows of numbers as text") {
  const ArrayFile file;
  const std::vector<double> values{1, 2.5, -3e-2, 4};
  CHECK(file.read("1, 2.5\n-3e-2,4\n").values == values);
  CHECK(file.read("# metres\n\n1\t2.5\r\n-3e-2  +4").values == values);
  CHECK(file.read("1;2.5\n-3e-2;4\n").resolution == glm::uvec2(2, 2));
  CHECK(std::isnan(file.read("1 nan\n2 3\n").values[1]));
  CHECK_THAT(file.refusal("1,2\n3\n"), Contains(":2: expected 2 numbers as in the rows before, found 1"));
  CHECK_THAT(file.refusal("1,2\n3,x\n"), Contains(":2:3: expected a number, found \"x\""));
  CHECK(std::isnan(file.read("1,,2\n").values[1]));
  CHECK(std::isnan(file.read(";2.5\n3;4\n").values[0]));
  CHECK(file.read("c0,c1\n1,2\n3,4\n").values == std::vector<double>{1, 2, 3, 4});
  CHECK(file.read("# m\n\"left\" _right\n1 2\n").values == std::vector<double>{1, 2});
  CHECK_THAT(file.refusal("1,2\nc0,c1\n"), Contains(":2:1: expected a number, found \"c0\""));
  CHECK_THAT(file.refusal("c0,c1\nc2,c3\n"), Contains(":2:1: expected a number"));
  CHECK_THAT(file.refusal("{\n1\n"), Contains(":1:1: expected a number"));
  CHECK_THAT(file.refusal("1,5;2,5\n"),
             Contains(":1:1: expected a number with a decimal point, not a comma"));
  CHECK_THAT(file.refusal("\n# nothing\n"), Contains("found no number"));
  CHECK_THAT(file.refusal(std::string("GIF89a\0\0", 8)), Contains("expected an image as NPY"));
}

TEST_CASE("NPY that is none") {
  const ArrayFile file;
  const std::string data = bytes_of(std::vector<float>(6, 1.0f));
  const std::string whole = npy(header_of("<f4", "(2, 3)"), data);
  for (std::size_t length = 6; length < whole.size(); ++length) {
    INFO(length << " bytes of " << whole.size());
    CHECK(file.refusal(whole.substr(0, length)) != "none");
  }
  CHECK_THAT(file.refusal(whole + "x"),
             Contains("expected 2 x 3 values of 4 bytes each (rows x columns), found 25"));
  CHECK_THAT(file.refusal(npy(header_of("<f4", "(6,)"), data)),
             Contains("rows x columns, found one of 1 dim"));
  CHECK_THAT(file.refusal(npy(header_of("<f4", "(0, 3)"), "")), Contains("rows x columns"));
  CHECK_THAT(file.refusal(npy(header_of("<f4", "(4294967296, 4294967296)"), data)),
             Contains("rows x columns"));
  CHECK_THAT(file.refusal(npy(header_of("<f4", "(2147483647, 2147483647)"), data)),
             Contains("found 24 bytes"));
  CHECK_THAT(file.refusal(npy(header_of("<c8", "(1, 3)"), data)), Contains("found \"<c8\""));
  CHECK_THAT(file.refusal(npy(header_of("|O", "(1, 3)"), data)), Contains("float32, float64"));
  CHECK_THAT(file.refusal(npy("{'descr': '<f4'", data)), Contains("expected an NPY header"));
  CHECK_THAT(file.refusal(npy("{'descr': '<f4', 'shape': (99999999999999999999, 1)}", data)),
             Contains("header"));
}

TEST_CASE("damaged NPZ and NPY bring nothing down") {
  const test::TemporaryFolder folder;
  const std::vector<float> values(12, 1.0f);
  {
    OutputFile file(folder.path() / "whole.npz");
    write_npz(file, {{4, 3}, {{"distance_m", "m", std::span(values)}}});
    file.close();
    file.publish();
  }
  std::string whole;
  {
    std::FILE *stream = std::fopen((folder.path() / "whole.npz").c_str(), "rb");
    REQUIRE(stream);
    for (int c = 0; (c = std::fgetc(stream)) != EOF;)
      whole += static_cast<char>(c);
    std::fclose(stream);
  }
  std::mt19937 random(3);
  const ArrayFile file;
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    if (i % 4 == 0)
      damaged.resize(random() % damaged.size());
    try {
      for (const ImageArray &array : read_image_arrays(folder.write("image", damaged), any_name).arrays)
        CHECK(array.values.size() == std::size_t{array.resolution.x} * array.resolution.y);
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::input);
    }
  }
}

TEST_CASE("a grey PNG of 16 bits") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() / "depth.png";
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3, image.height = 2;
  image.format = PNG_FORMAT_LINEAR_Y;
  const std::vector<std::uint16_t> millimetres{0, 1, 255, 256, 1000, 65535};
  REQUIRE(png_image_write_to_file(&image, path.c_str(), 0, millimetres.data(), 0, nullptr) != 0);
  const ImageArray array = read_image_arrays(path, any_name).arrays.at(0);
  CHECK(array.values == std::vector<double>(millimetres.begin(), millimetres.end()));
  CHECK(array.resolution == glm::uvec2(3, 2));
  CHECK(array.whole_numbers);
}
