// Small files that would take much memory: each ends in one line that names the file, and takes little.

#include "engine/model/error.h"
#include "host/input/array/image_array.h"
#include "host/input/file/json_file.h"
#include "host/input/frame/frame_file.h"
#include "host/input/gltf/loader.h"
#include "host/input/image/image_pixels.h"
#include "host/memory/machine_memory.h"
#include "host/memory/memory_limit.h"
#include "host/output/files/channel.h"
#include "host/output/files/h5_writer.h"
#include "tests/host/input/calibration/calibration_texts.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/image/image_bytes.h"
#include "tests/host/input/setup/setup_fixture.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <malloc.h>
#include <random>
#include <span>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using nlohmann::json;

namespace {

// While it lives, the process may take no more than so much beside what it has.
class LittleMemory {
public:
  explicit LittleMemory(std::uint64_t bytes) {
    malloc_trim(0); // what was freed is not taken
    set_max_memory(taken_memory() + bytes);
  }
  ~LittleMemory() { set_max_memory(std::nullopt); }
  LittleMemory(const LittleMemory &) = delete;
  LittleMemory &operator=(const LittleMemory &) = delete;
};

constexpr std::uint64_t little = 40'000'000;

// The line of what `action` throws where there is little memory, of which it takes no more than that.
template <class Action>
std::string out_of_memory_of(Action action) {
  const std::uint64_t before = taken_memory();
  const LittleMemory limit(little);
  try {
    action();
  } catch (const Error &error) {
    const std::string message = error.what();
    CHECK(error.code() == ExitCode::out_of_memory);
    CHECK(message.find('\n') == message.npos);
    CHECK(taken_memory() < before + 2 * little);
    return message;
  }
  FAIL_CHECK("nothing was thrown");
  return {};
}

std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i)
    all += text;
  return all;
}

constexpr std::size_t side = 4000;

ChannelSet zeros() {
  static const std::vector<float> values(side * side, 0.0f);
  return {{side, side}, {{"distance_m", "m", std::span(values)}}};
}

const auto any_array = [](std::string_view) { return true; };

} // namespace

TEST_CASE("JSON of very many values is refused before it is built") {
  const std::string values = "[" + repeated("0,", max_json_values) + "0]";
  CHECK(input_error_of([&] { parse_json(values, "scene.gltf", Comments::refused); }) ==
        "scene.gltf: expected at most 16777216 values");
  const std::string lists = "[" + repeated("[],", 1'000'000) + "0]";
  CHECK_THAT(out_of_memory_of([&] { parse_json(lists, "scene.gltf", Comments::refused); }),
             Contains("scene.gltf: out of memory: a document of 1000002 values needs 70 MB beside the "));
}

TEST_CASE("images ask for the memory of their pixels") {
  const TemporaryFolder folder;
  const auto file = folder.write("large.png", png_header(10000, 9000));
  CHECK_THAT(out_of_memory_of([&] { read_image_arrays(file, any_array); }),
             Contains("large.png: out of memory: an image of 10000 x 9000 needs 360 MB"));
}

TEST_CASE("JPEGs ask for the memory of their coefficients, too") {
  const std::string bytes = jpeg_of_one_pixel(3000, 2000);
  const std::span shown(reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
  CHECK_THAT(out_of_memory_of([&] { decoded_image(shown, side * side, Place{"large.jpg"}); }),
             Contains("large.jpg: out of memory: an image of 3000 x 2000 needs 60 MB"));
}

TEST_CASE("frames that were compressed well ask for the memory of their channels") {
  const TemporaryFolder folder;
  {
    OutputFile file(folder.path() / "frame.exr");
    write_exr(file, zeros());
    file.close();
    file.publish();
  }
  CHECK(std::filesystem::file_size(folder.path() / "frame.exr") < 1'000'000);
  CHECK_THAT(out_of_memory_of([&] { read_frame(folder.path() / "frame.exr"); }),
             Contains("frame.exr: out of memory: 4000 x 4000 pixels needs 64 MB"));
}

TEST_CASE("frames of HDF5 ask for the memory of a chunk beside that of their values") {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  std::vector<float> values(2000 * 2000); // 16 MB, as the file has, and the chunk may have
  for (float &value : values)
    value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  {
    OutputFile file(folder.path() / "frame.h5");
    write_h5(file, {{2000, 2000}, {{"distance_m", "m", std::span(values)}}}, {Sensor{}, 0, 0.0});
    file.close();
    file.publish();
  }
  CHECK_THAT(out_of_memory_of([&] { read_frame(folder.path() / "frame.h5"); }),
             Contains("frame.h5: out of memory: 2000 x 2000 pixels and a chunk of them needs 32 MB"));
}

TEST_CASE("arrays in an archive ask for memory as they grow") {
  const TemporaryFolder folder;
  {
    OutputFile file(folder.path() / "large.npz");
    write_npz(file, zeros());
    file.close();
    file.publish();
  }
  CHECK_THAT(out_of_memory_of([&] { read_image_arrays(folder.path() / "large.npz", any_array); }),
             Contains("large.npz: out of memory: "));
}

TEST_CASE("lines of numbers ask for the memory of their fields") {
  const TemporaryFolder folder;
  const auto file = folder.write("long.txt", repeated("1 ", 5'000'000));
  CHECK_THAT(out_of_memory_of([&] { read_image_arrays(file, any_array); }),
             Contains("long.txt: out of memory: a line of it needs "));
}

TEST_CASE("lists of a scene ask for the memory of what they become") {
  const TemporaryFolder folder;
  json gltf = one_triangle();
  gltf["nodes"] = json::array_t(60'000, gltf["nodes"][0]);
  const auto file = folder.write("scene.gltf", gltf.dump());
  CHECK_THAT(out_of_memory_of([&] { load_gltf(file, Place{file}).at(0); }),
             Contains("scene.gltf: out of memory: a model of its lists needs "));
}

TEST_CASE("a scene that is wrong in very many places asks for the memory to tell of one") {
  const TemporaryFolder folder;
  json gltf = one_triangle();
  gltf["nodes"] = json::array_t(200'000, 0);
  const auto file = folder.write("scene.gltf", gltf.dump());
  CHECK_THAT(out_of_memory_of([&] { load_gltf(file, Place{file}); }),
             Contains("out of memory: looking for what is wrong needs "));
}

TEST_CASE("what others add to a scene is not copied", "[no_sanitizer]") {
  const TemporaryFolder folder;
  json gltf = one_triangle();
  gltf["nodes"][0]["extras"] = json::array_t(300'000, 0); // 150 bytes each in tinygltf
  gltf["nodes"][0]["extensions"]["SOME_other"] = json::array_t(300'000, 0);
  gltf["extensionsUsed"] = {"SOME_other"};
  const auto file = folder.write("scene.gltf", gltf.dump());
  malloc_trim(0); // what was freed is not taken
  const std::uint64_t before = taken_memory();
  const GltfFile scene = load_gltf(file, Place{file});
  CHECK(scene.at(0).scene.triangles.size() == 1);
  malloc_trim(0);
  CHECK(taken_memory() < before + 20'000'000);
}

TEST_CASE("primitives that share an accessor ask for the memory of each") {
  constexpr std::size_t vertices = 999'999; // zeros, of which the file has no bytes
  json gltf = one_triangle();
  gltf["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", vertices}};
  json &primitives = gltf["meshes"][0]["primitives"];
  primitives[0].erase("indices");
  for (int i = 0; i < 100; ++i)
    primitives.push_back(primitives[0]);
  const TemporaryFolder folder;
  const auto file = folder.write("scene.gltf", gltf.dump());
  CHECK(std::filesystem::file_size(file) < 20'000);
  CHECK_THAT(out_of_memory_of([&] { load_gltf(file, Place{file}).at(0); }),
             Contains("scene.gltf: /meshes/0/primitives/") || Contains("scene.gltf: /accessors/0"));
}

TEST_CASE("lists in XML have as many values as those in YAML at most, and entities are not expanded") {
  const std::string head = "<?xml version=\"1.0\"?>\n<opencv_storage><image_width>640</image_width>";
  CHECK_THAT(calibration_error_of(head + "<data>" + repeated("1 ", 300'000) + "</data></opencv_storage>"),
             EndsWith(": expected at most 250000 values"));
  CHECK_THAT(calibration_error_of("<?xml version=\"1.0\"?>\n<!DOCTYPE x [<!ENTITY a \"1111\"><!ENTITY b "
                                  "\"&a;&a;&a;&a;\">]>\n<opencv_storage><image_width>&b;</image_width>"
                                  "<image_height>4</image_height></opencv_storage>"),
             Contains("&b;"));
}
