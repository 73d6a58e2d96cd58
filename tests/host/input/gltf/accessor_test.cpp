// Accessors as tools write them: sparse, of zeros, normalized and quantized; and what is wrong in them.

#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

using Positions = std::vector<glm::dvec3>;

// A triangle of which vertices 0 and 2 are elsewhere.
json sparse_triangle() {
  json gltf = one_triangle();
  const std::size_t indices = add_view(gltf, bytes_of<std::uint16_t>({0, 2}));
  const std::size_t values = add_view(gltf, bytes_of<float>({5, 6, 7, 8, 9, 10}));
  gltf["accessors"][0]["sparse"] = {{"count", 2},
                                    {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                    {"values", {{"bufferView", values}}}};
  return gltf;
}

std::string sparse_error(const std::string &pointer, const json &value) {
  json gltf = sparse_triangle();
  gltf[json::json_pointer(pointer)] = value;
  return scene_error_of(gltf);
}

std::string index_error(const std::vector<std::uint16_t> &indices) {
  json gltf = sparse_triangle();
  gltf["buffers"][1]["uri"] = data_uri(bytes_of(indices));
  return scene_error_of(gltf);
}

// A triangle whose POSITION is a list of integers.
template <class T>
json integer_triangle(const std::vector<T> &components, int component_type, bool normalized) {
  json gltf = one_triangle();
  const std::size_t accessor = add_accessor(gltf, bytes_of(components), component_type, 3, "VEC3");
  gltf["accessors"][accessor]["normalized"] = normalized;
  gltf["bufferViews"].back()["byteStride"] = 4 * sizeof(T); // three components, padded
  gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
  gltf["extensionsUsed"] = {"KHR_mesh_quantization"};
  return gltf;
}

} // namespace

TEST_CASE("Sparse elements replace those of the bufferView") {
  CHECK(scene_of(sparse_triangle()).positions_m == Positions{{5, 6, 7}, {1, -1, -1}, {8, 9, 10}});
}

TEST_CASE("Sparse elements without a bufferView replace zeros") {
  json gltf = sparse_triangle();
  gltf["accessors"][0].erase("bufferView");
  CHECK(scene_of(gltf).positions_m == Positions{{5, 6, 7}, {0, 0, 0}, {8, 9, 10}});
}

TEST_CASE("Sparse parts have offsets, and indices of 8, 16 and 32 bit") {
  const auto positions_with = [](const std::string &indices, int component_type) {
    json gltf = one_triangle();
    const std::size_t view = add_view(gltf, indices);
    const std::size_t values = add_view(gltf, bytes_of<float>({9, 9, 5, 6, 7}));
    gltf["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices",
         {{"bufferView", view}, {"componentType", component_type}, {"byteOffset", indices.size() / 2}}},
        {"values", {{"bufferView", values}, {"byteOffset", 8}}}};
    return scene_of(gltf).positions_m;
  };
  const Positions expected{{-1, -1, -1}, {5, 6, 7}, {0, 1, -1}};
  CHECK(positions_with(bytes_of<std::uint8_t>({9, 1}), 5121) == expected);
  CHECK(positions_with(bytes_of<std::uint16_t>({9, 1}), 5123) == expected);
  CHECK(positions_with(bytes_of<std::uint32_t>({9, 1}), 5125) == expected);
}

TEST_CASE("Indices may be sparse") {
  json gltf = document(triangle_positions(), {0, 1, 1}, 4);
  const std::size_t indices = add_view(gltf, bytes_of<std::uint8_t>({2}));
  const std::size_t values = add_view(gltf, bytes_of<std::uint16_t>({2}));
  gltf["accessors"][1]["sparse"] = {{"count", 1},
                                    {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                    {"values", {{"bufferView", values}}}};
  CHECK(scene_of(gltf).triangles.at(0).vertices == std::array<std::uint32_t, 3>{0, 1, 2});
  gltf["buffers"].back()["uri"] = data_uri(bytes_of<std::uint16_t>({3}));
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1: element 2 is vertex 3, expected one below 3"));
}

TEST_CASE("An accessor without a bufferView is zeros, up to a limit") {
  json gltf = one_triangle();
  gltf["accessors"][0].erase("bufferView");
  CHECK(scene_of(gltf).positions_m == Positions(3, {0, 0, 0}));
  for (const std::size_t count : {std::size_t{1048577}, std::size_t{4294967295}}) {
    gltf["accessors"][0]["count"] = count;
    CHECK_THAT(scene_error_of(gltf),
               EndsWith("/accessors/0/count: expected at most 1048576 elements without a bufferView, found " +
                        std::to_string(count)));
  }
}

TEST_CASE("Quantized positions of 8 and 16 bit, plain and normalized") {
  const std::vector<std::int8_t> bytes = {-128, -127, 0, 0, 127, 64, 1, 0, -1, -64, 3, 0};
  CHECK(scene_of(integer_triangle(bytes, 5120, false)).positions_m ==
        Positions{{-128, -127, 0}, {127, 64, 1}, {-1, -64, 3}});
  CHECK(scene_of(integer_triangle(bytes, 5120, true)).positions_m ==
        Positions{{-1, -1, 0}, {1, 64 / 127.0, 1 / 127.0}, {-1 / 127.0, -64 / 127.0, 3 / 127.0}});
  const std::vector<std::uint8_t> unsigned_bytes = {0, 51, 255, 0, 1, 2, 3, 0, 4, 5, 6, 0};
  CHECK(scene_of(integer_triangle(unsigned_bytes, 5121, true)).positions_m.at(0) == glm::dvec3(0, 0.2, 1));
  const std::vector<std::int16_t> shorts = {-32768, -32767, 32767, 0, 1, 2, 3, 0, 4, 5, 6, 0};
  CHECK(scene_of(integer_triangle(shorts, 5122, false)).positions_m.at(0) ==
        glm::dvec3(-32768, -32767, 32767));
  CHECK(scene_of(integer_triangle(shorts, 5122, true)).positions_m.at(0) == glm::dvec3(-1, -1, 1));
  const std::vector<std::uint16_t> unsigned_shorts = {0, 13107, 65535, 0, 1, 2, 3, 0, 4, 5, 6, 0};
  CHECK(scene_of(integer_triangle(unsigned_shorts, 5123, false)).positions_m.at(0) ==
        glm::dvec3(0, 13107, 65535));
  CHECK(scene_of(integer_triangle(unsigned_shorts, 5123, true)).positions_m.at(0) == glm::dvec3(0, 0.2, 1));
}

TEST_CASE("A node takes quantized positions back to metres") {
  json gltf = integer_triangle<std::uint16_t>({0, 0, 0, 0, 1000, 2000, 3000, 0, 1, 2, 3, 0}, 5123, false);
  gltf["nodes"][0]["scale"] = {0.001, 0.001, 0.001};
  gltf["nodes"][0]["translation"] = {-1, 0, 1};
  CHECK(glm::length(scene_of(gltf).positions_m.at(1) - glm::dvec3(0, 2, 4)) < 1e-15);
}

TEST_CASE("Integers are positions only with KHR_mesh_quantization, and 32 bit never") {
  json gltf = integer_triangle<std::uint16_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5123, true);
  gltf.erase("extensionsUsed");
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1/componentType: normalized 5123 is not allowed for "
                                            "POSITION without the extension KHR_mesh_quantization"));
  gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
  CHECK_NOTHROW(scene_of(gltf));
  gltf["accessors"][1]["componentType"] = 5125;
  gltf["accessors"][1]["normalized"] = false;
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1/componentType: 5125 is not allowed for POSITION"));
}

TEST_CASE("Sparse indices that lead nowhere or back") {
  CHECK_THAT(index_error({0, 3}),
             EndsWith("/accessors/0/sparse/indices: index 1 is 3, the accessor has 3 elements"));
  CHECK_THAT(index_error({1, 1}),
             EndsWith("/accessors/0/sparse/indices: index 1 is 1 after 1, expected them to increase"));
  CHECK_THAT(index_error({2, 0}),
             EndsWith("/accessors/0/sparse/indices: index 1 is 0 after 2, expected them to increase"));
}

TEST_CASE("Sparse parts that are not where or what they are said to be") {
  CHECK_THAT(sparse_error("/accessors/0/sparse/count", 3),
             EndsWith("/accessors/0/sparse/indices: 3 elements end at byte 6, the bufferView has 4"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/count", 4),
             EndsWith("/accessors/0/sparse/count: expected at most 3, as many as the accessor's elements"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/count", 0), Contains("/sparse/count: expected an integer"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/count", 2147483648u),
             Contains("/sparse/count: expected an integer"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/values/byteOffset", 4),
             EndsWith("/accessors/0/sparse/values: 2 elements end at byte 28, the bufferView has 24"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/values/byteOffset", 2147483648u),
             Contains("/sparse/values/byteOffset: expected an integer"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/indices/byteOffset", 2147483647),
             Contains("/sparse/indices: 2 elements end at byte 2147483651"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/indices/bufferView", 9),
             EndsWith("/accessors/0/sparse/indices/bufferView: index 9 into /bufferViews, which has 3"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/values/bufferView", 3),
             Contains("/sparse/values/bufferView: index 3 into /bufferViews"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/indices/componentType", 5126),
             Contains("/sparse/indices/componentType: expected 5121 or 5123 or 5125, found 5126"));
  CHECK_THAT(sparse_error("/accessors/0/sparse/indices", json::object()),
             EndsWith("/accessors/0/sparse/indices: missing key \"bufferView\""));
  CHECK_THAT(sparse_error("/accessors/0/sparse", json::object()),
             EndsWith("/accessors/0/sparse: missing key \"count\""));
  CHECK_THAT(sparse_error("/bufferViews/2/byteStride", 12),
             EndsWith("/accessors/0/sparse/values/bufferView: bufferView 2 has a byteStride, expected none"));
  CHECK_THAT(sparse_error("/bufferViews/1/byteLength", 5),
             EndsWith("/bufferViews/1: ends at byte 5, its buffer has 4"));
}
