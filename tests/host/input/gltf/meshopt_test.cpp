// EXT_meshopt_compression: what a compressed view holds, and what is wrong in one.

#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"
#include "tests/host/input/gltf/meshopt_builder.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

using Positions = std::vector<glm::dvec3>;

constexpr const char *part = "/extensions/EXT_meshopt_compression";

// The square with one value of a compressed bufferView replaced: 2 is ATTRIBUTES, 3 TRIANGLES.
std::string error_of_view(std::size_t view, const std::string &key, const json &value) {
  json gltf = compressed_square();
  compression(gltf, view)[key] = value;
  return scene_error_of(gltf);
}

// A triangle whose positions are 16-bit integers that a filter makes, of these bytes.
template <class T>
json filtered_triangle(const std::vector<T> &values, std::size_t stride_bytes, const std::string &filter,
                       int component_type) {
  json gltf = one_triangle();
  const std::size_t view =
      add_compressed_view(gltf, vertex_stream(bytes_of(values), stride_bytes), "ATTRIBUTES", stride_bytes, 3);
  compression(gltf, view)["filter"] = filter;
  gltf["bufferViews"][view]["byteStride"] = stride_bytes;
  gltf["accessors"][0]["bufferView"] = view;
  gltf["accessors"][0]["componentType"] = component_type;
  gltf["accessors"][0]["normalized"] = component_type != 5126;
  gltf["extensionsRequired"] = {"KHR_mesh_quantization", "EXT_meshopt_compression"};
  return gltf;
}

} // namespace

TEST_CASE("Compressed attributes and triangles are those that were compressed") {
  const Scene scene = scene_of(compressed_square());
  CHECK(scene.positions_m == Positions{{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}});
  CHECK(vertices_of(scene) == Ids{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("Compressed index sequences of 16 and 32 bit") {
  for (const std::size_t index_bytes : {2u, 4u}) {
    json gltf = compressed_square();
    gltf["accessors"][1]["bufferView"] =
        add_compressed_view(gltf, index_stream({3, 2, 1, 0}), "INDICES", index_bytes, 4);
    gltf["accessors"][1]["componentType"] = index_bytes == 2 ? 5123 : 5125;
    gltf["accessors"][1]["count"] = 4;
    gltf["meshes"][0]["primitives"][0]["mode"] = 6;
    CHECK(vertices_of(scene_of(gltf)) == Ids{{2, 1, 3}, {1, 0, 3}});
  }
}

TEST_CASE("A stream may lie anywhere in its buffer") {
  json gltf = compressed_square();
  const std::string stream = vertex_stream(bytes_of<float>({0, 0, -1, 1, 0, -1, 1, 1, -1, 0, 7, -1}), 12);
  gltf["buffers"][1] = {{"byteLength", stream.size() + 8}, {"uri", data_uri("12345" + stream + "678")}};
  compression(gltf, 2)["byteOffset"] = 5;
  compression(gltf, 2)["byteLength"] = stream.size();
  CHECK(scene_of(gltf).positions_m.at(3) == glm::dvec3(0, 7, -1));
}

TEST_CASE("Fallback buffers need not be there, marked or not") {
  json gltf = compressed_square();
  gltf["buffers"][2]["uri"] = "absent.bin";
  CHECK(scene_of(gltf).positions_m.size() == 4);
  gltf["buffers"][2].erase("uri");
  gltf["buffers"][2].erase("extensions");
  CHECK(scene_of(gltf).positions_m.size() == 4);
  gltf["bufferViews"].push_back({{"buffer", 2}, {"byteLength", 4}});
  CHECK_THAT(scene_error_of(gltf), EndsWith("/buffers/2: missing key \"uri\""));
}

TEST_CASE("The exponential filter: 24 bits of mantissa, 8 of exponent") {
  const auto number = [](int exponent, int mantissa) {
    return static_cast<std::uint32_t>(exponent) << 24 | (static_cast<std::uint32_t>(mantissa) & 0xffffffu);
  };
  const std::vector<std::uint32_t> values = {number(1, 3),  number(-2, 5), number(0, -7),
                                             number(-1, 1), number(3, -1), number(0, 0),
                                             number(2, 2),  number(0, 1),  number(-3, 8)};
  CHECK(scene_of(filtered_triangle(values, 12, "EXPONENTIAL", 5126)).positions_m ==
        Positions{{6, 1.25, -7}, {0.5, -8, 0}, {8, 1, 1}});
}

TEST_CASE("The octahedral filter makes unit vectors") {
  // x and y of the octahedron's sides, z its scale; the fourth stays.
  const std::vector<std::int16_t> values = {0, 0, 100, 0, 100, 0, 100, 0, 0, -100, 100, 0};
  const Positions vectors = scene_of(filtered_triangle(values, 8, "OCTAHEDRAL", 5122)).positions_m;
  CHECK(glm::length(vectors.at(0) - glm::dvec3(0, 0, 1)) < 1e-4);
  CHECK(glm::length(vectors.at(1) - glm::dvec3(1, 0, 0)) < 1e-4);
  CHECK(glm::length(vectors.at(2) - glm::dvec3(0, -1, 0)) < 1e-4);
}

TEST_CASE("The quaternion filter finds the largest component") {
  // Three components over sqrt(2) times the scale, which ends in the bits that tell which is left out.
  const std::int16_t scale = 4 * 1000 + 3, without_x = 4 * 1000;
  const std::vector<std::int16_t> values = {0, 0, 0, scale, 0, 4003, 0, scale, 0, 0, 0, without_x};
  const Positions vectors = scene_of(filtered_triangle(values, 8, "QUATERNION", 5122)).positions_m;
  CHECK(glm::length(vectors.at(0)) < 1e-4);
  CHECK(glm::length(vectors.at(1) - glm::dvec3(0, std::sqrt(0.5), 0)) < 1e-3);
  CHECK(glm::length(vectors.at(2) - glm::dvec3(1, 0, 0)) < 1e-4);
}

TEST_CASE("Compressed views whose layout breaks the extension's rules") {
  CHECK_THAT(
      error_of_view(2, "byteStride", 10),
      EndsWith("/bufferViews/2/extensions/EXT_meshopt_compression/byteStride: expected a multiple of 4 "
               "for \"ATTRIBUTES\", found 10"));
  CHECK_THAT(error_of_view(2, "byteStride", 260), Contains("/byteStride: expected an integer from 2 to 256"));
  CHECK_THAT(error_of_view(2, "byteStride", 16),
             EndsWith("/bufferViews/2/byteLength: expected 64, 4 elements of 16 bytes, found 48"));
  CHECK_THAT(error_of_view(3, "byteStride", 8),
             EndsWith(std::string(part) + "/byteStride: expected 2 or 4 for indices, found 8"));
  CHECK_THAT(error_of_view(2, "count", 5),
             EndsWith("/bufferViews/2/byteLength: expected 60, 5 elements of 12 "
                      "bytes, found 48"));
  CHECK_THAT(error_of_view(2, "count", 0), Contains("/count: expected an integer from 1 to 4294967295"));
  CHECK_THAT(error_of_view(3, "count", 7),
             EndsWith(std::string(part) + "/count: expected a multiple of 3 for \"TRIANGLES\", found 7"));
  json gltf = compressed_square();
  gltf["bufferViews"][2]["byteStride"] = 16;
  CHECK_THAT(scene_error_of(gltf),
             EndsWith(std::string(part) + "/byteStride: expected the bufferView's 16, found 12"));
}

TEST_CASE("Compressed views with an unknown mode or a filter that does not fit") {
  CHECK_THAT(error_of_view(2, "mode", "POINTS"),
             EndsWith("/mode: expected \"ATTRIBUTES\" or \"TRIANGLES\" or \"INDICES\", found \"POINTS\""));
  CHECK_THAT(error_of_view(2, "filter", "COLOR"), Contains("/filter: expected \"NONE\" or \"OCTAHEDRAL\""));
  CHECK_THAT(error_of_view(3, "filter", "EXPONENTIAL"),
             EndsWith(std::string(part) + "/filter: expected \"NONE\" for \"TRIANGLES\""));
  CHECK_THAT(error_of_view(2, "filter", "OCTAHEDRAL"),
             EndsWith("/byteStride: expected 4 or 8 for \"OCTAHEDRAL\", found 12"));
  CHECK_THAT(error_of_view(2, "filter", "QUATERNION"),
             EndsWith("/byteStride: expected 8 for \"QUATERNION\", found 12"));
}

TEST_CASE("Streams that are not where they are said to be") {
  CHECK_THAT(
      error_of_view(2, "buffer", 5),
      EndsWith("/bufferViews/2/extensions/EXT_meshopt_compression/buffer: index 5 into /buffers, which "
               "has 5"));
  CHECK_THAT(error_of_view(2, "byteOffset", 1), Contains(std::string(part) + ": ends at byte "));
  CHECK_THAT(error_of_view(2, "byteOffset", 9007199254740991),
             Contains(std::string(part) + ": ends at byte 9007199254741"));
  CHECK_THAT(error_of_view(2, "byteLength", 100000),
             Contains(std::string(part) + ": ends at byte 100000, its buffer has "));
  CHECK_THAT(error_of_view(2, "buffer", 2), Contains(", its buffer has 0")); // a fallback buffer
  json gltf = compressed_square();
  compression(gltf, 2).erase("count");
  CHECK_THAT(scene_error_of(gltf), EndsWith(std::string(part) + ": missing key \"count\""));
  gltf = compressed_square();
  gltf["bufferViews"][2]["byteOffset"] = 4;
  CHECK_THAT(scene_error_of(gltf), EndsWith("/bufferViews/2: ends at byte 52, its buffer has 48"));
}

TEST_CASE("Streams that cannot be decoded") {
  const auto error_of_stream = [](const std::string &stream) {
    json gltf = compressed_square();
    gltf["buffers"][1] = {{"byteLength", stream.size()}, {"uri", data_uri(stream)}};
    compression(gltf, 2)["byteLength"] = stream.size();
    return scene_error_of(gltf);
  };
  const std::string expected =
      std::string("/bufferViews/2") + part + ": its bytes cannot be decoded as 4 elements of \"ATTRIBUTES\"";
  const std::string good = vertex_stream(std::string(48, 'x'), 12);
  CHECK_THAT(error_of_stream('\x01' + good.substr(1)), EndsWith(expected));
  CHECK_THAT(error_of_stream(good.substr(0, good.size() - 1)), EndsWith(expected));
  CHECK_THAT(error_of_stream(good + "more"), EndsWith(expected));
  CHECK_THAT(error_of_view(2, "byteLength", 1), EndsWith(expected));
  CHECK_THAT(error_of_view(3, "mode", "INDICES"), Contains("cannot be decoded as 6 elements of \"INDICES\""));
}

TEST_CASE("What a stream claims to hold costs nothing before it can") {
  json gltf = compressed_square();
  compression(gltf, 2)["count"] = 80'000'000;
  gltf["bufferViews"][2]["byteLength"] = 960'000'000;
  gltf["buffers"][2]["byteLength"] = 960'000'000;
  CHECK_THAT(scene_error_of(gltf), Contains("bytes are too short for 80000000 elements of 12 bytes"));
  compression(gltf, 2)["count"] = 4294967295;
  CHECK_THAT(scene_error_of(gltf), Contains("too short for 4294967295 elements"));
}

TEST_CASE("Decoded views count among the bytes of all buffers") {
  // 20 streams of 64 MiB of zeros each.
  json gltf = compressed_square();
  const std::string stream = vertex_stream(std::string(1 << 26, '\0'), 256);
  gltf["buffers"][1] = {{"byteLength", stream.size()}, {"uri", data_uri(stream)}};
  gltf["buffers"][2]["byteLength"] = 1 << 26;
  gltf["bufferViews"][2]["byteLength"] = 1 << 26;
  compression(gltf, 2)["byteLength"] = stream.size();
  compression(gltf, 2)["byteStride"] = 256;
  compression(gltf, 2)["count"] = 1 << 18;
  for (int i = 0; i < 19; ++i)
    gltf["bufferViews"].push_back(gltf["bufferViews"][2]);
  CHECK_THAT(
      scene_error_of(gltf),
      EndsWith(std::string(part) + "/count: expected at most 1073741824 bytes in all buffers, decoded"));
}

TEST_CASE("Only compressed views refer to a fallback buffer") {
  json gltf = compressed_square();
  gltf["bufferViews"].push_back({{"buffer", 2}, {"byteLength", 4}});
  CHECK_THAT(scene_error_of(gltf),
             EndsWith("/bufferViews/4/buffer: is a fallback buffer, expected EXT_meshopt_compression here"));
}

TEST_CASE("Indices that no vertex has are found after decoding") {
  json gltf = compressed_square();
  gltf["accessors"][1]["bufferView"] =
      add_compressed_view(gltf, triangle_stream({0, 1, 2, 0, 2, 4}), "TRIANGLES", 2, 6);
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1: element 5 is vertex 4, expected one below 4"));
}
