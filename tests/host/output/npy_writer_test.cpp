#include "host/output/files/channel.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <numeric>
#include <vector>

using namespace pmdsim;

namespace {

std::string npy_bytes(const Channel &channel, const glm::uvec2 &resolution) {
  const pmdsim::test::TemporaryFolder temporary;
  OutputFile file(temporary.path() / "array.npy");
  write_npy(file, channel, resolution);
  file.close();
  file.publish();
  return content_of(file.path());
}

} // namespace

TEST_CASE("an array of floats is NumPy's version 1.0, byte by byte") {
  const std::vector<float> values{1.0f, -2.0f, 0.5f, 4.0f, 5.0f, 6.0f};
  const std::string bytes = npy_bytes({"z_m", "m", std::span<const float>(values)}, {3, 2});
  REQUIRE(bytes.size() == 128 + 6 * 4);
  CHECK(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  CHECK(bytes.substr(8, 2) == std::string("\x76\x00", 2)); // 118 bytes follow
  const std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
  CHECK(bytes.substr(10, 118) == header + std::string(117 - header.size(), ' ') + "\n");
  CHECK(bytes.substr(128, 8) == std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0", 8)); // 1, -2
}

TEST_CASE("a large array is there to its last byte, beside whatever is written before and after it") {
  std::vector<float> values(700 * 301);
  std::iota(values.begin(), values.end(), 1.0f);
  const std::string bytes = npy_bytes({"z_m", "m", std::span<const float>(values)}, {700, 301});
  REQUIRE(bytes.size() == 128 + values.size() * sizeof(float));
  CHECK(std::memcmp(bytes.data() + 128, values.data(), values.size() * sizeof(float)) == 0);
  const pmdsim::test::TemporaryFolder temporary;
  OutputFile file(temporary.path() / "parts");
  const std::string large(1 << 20, 'x');
  for (const std::string &part : {std::string("before"), large, std::string("after")})
    file.write(part);
  file.close();
  file.publish();
  CHECK(content_of(file.path()) == "before" + large + "after");
}

TEST_CASE("an array of ids is unsigned") {
  const std::vector<std::uint32_t> values{0x04030201u};
  const std::string bytes = npy_bytes({"object_id", "", std::span<const std::uint32_t>(values)}, {1, 1});
  CHECK(bytes.find("'descr': '<u4'") != std::string::npos);
  CHECK(bytes.substr(bytes.size() - 4) == "\x01\x02\x03\x04");
}

TEST_CASE("data start at a multiple of 64 bytes whatever the shape's length") {
  for (const std::uint32_t columns : {1u, 12u, 1234u, 65536u}) {
    const std::vector<float> values(columns);
    const std::string bytes = npy_bytes({"z_m", "m", std::span<const float>(values)}, {columns, 1});
    CHECK((bytes.size() - columns * sizeof(float)) % 64 == 0);
  }
}
