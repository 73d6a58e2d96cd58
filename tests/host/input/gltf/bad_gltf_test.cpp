#include "host/input/gltf/loader.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/image/image_bytes.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <sys/stat.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// A folder that holds a scene's file, for what lies beside it.
struct SceneFile {
  TemporaryFolder folder;

  std::string error_of_bytes(const std::string &bytes) const {
    const auto file = folder.write("scene.gltf", bytes);
    return input_error_of([&] { load_gltf(file, Place{file}).at(0); });
  }
  std::string error_of(const json &gltf) const { return error_of_bytes(gltf.dump()); }
  std::string error_of_uri(const std::string &uri) const {
    json gltf = one_triangle();
    gltf["buffers"][0]["uri"] = uri;
    return error_of(gltf);
  }
};

// The error of a good scene in which one value is replaced.
std::string error_with(const std::string &pointer, const json &value, json gltf = one_triangle()) {
  gltf[json::json_pointer(pointer)] = value;
  return SceneFile().error_of(gltf);
}

json indexed() { return document(triangle_positions(), {0, 1, 2}, 4); }

} // namespace

TEST_CASE("Indices to nowhere") {
  CHECK_THAT(error_with("/scene", 5), EndsWith(" /scene: index 5 into /scenes, which has 1"));
  CHECK_THAT(error_with("/scenes/0/nodes/0", 1),
             EndsWith("/scenes/0/nodes/0: index 1 into /nodes, which has 1"));
  CHECK_THAT(error_with("/nodes/0/mesh", 3), EndsWith("/nodes/0/mesh: index 3 into /meshes, which has 1"));
  CHECK_THAT(error_with("/nodes/0/children", {9}), Contains("/nodes/0/children/0: index 9"));
  CHECK_THAT(error_with("/meshes/0/primitives/0/indices", 7), Contains("/indices: index 7 into /accessors"));
  CHECK_THAT(error_with("/meshes/0/primitives/0/material", 0),
             Contains("/material: index 0 into /materials"));
  CHECK_THAT(error_with("/meshes/0/primitives/0/attributes/POSITION", 7), Contains("/POSITION: index 7"));
  CHECK_THAT(error_with("/accessors/0/bufferView", 2), Contains("/accessors/0/bufferView: index 2"));
  CHECK_THAT(error_with("/bufferViews/0/buffer", 2), Contains("/bufferViews/0/buffer: index 2"));
}

TEST_CASE("Accessors beyond their buffers") {
  CHECK_THAT(error_with("/accessors/0/count", 4),
             EndsWith("/accessors/0: 4 elements end at byte 48, the bufferView has 36"));
  CHECK_THAT(error_with("/accessors/0/count", 4294967295u),
             Contains("/accessors/0: 4294967295 elements end at byte"));
  CHECK_THAT(error_with("/accessors/0/count", 4294967296u),
             Contains("/accessors/0/count: expected an integer from 1"));
  CHECK_THAT(error_with("/accessors/0/byteOffset", 4), Contains("/accessors/0: 3 elements end at byte 40"));
  CHECK_THAT(error_with("/accessors/0/byteOffset", 9007199254740991),
             Contains("/accessors/0: 3 elements end"));
  CHECK_THAT(error_with("/accessors/0/byteOffset", 18446744073709551615u),
             Contains("/accessors/0/byteOffset: expected"));
  CHECK_THAT(error_with("/bufferViews/0/byteLength", 37),
             EndsWith("/bufferViews/0: ends at byte 37, its buffer has 36"));
  CHECK_THAT(error_with("/bufferViews/0/byteStride", 8),
             EndsWith("/accessors/0: elements of 12 bytes lie 8 apart"));
  json missing = indexed();
  missing["accessors"][1].erase("bufferView");
  CHECK_THAT(SceneFile().error_of(missing),
             EndsWith("/accessors/1: missing key \"bufferView\", which indices need"));
  missing["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  CHECK_THAT(SceneFile().error_of(missing),
             Contains("; the file is packed with Draco: export without compression"));
}

TEST_CASE("Vertices and positions that are none") {
  CHECK_THAT(SceneFile().error_of(document(triangle_positions(), {0, 1, 3}, 4)),
             EndsWith("/accessors/1: element 2 is vertex 3, expected one below 3"));
  CHECK_THAT(SceneFile().error_of(document(triangle_positions(), {0, 1, 2, 65535}, 5)),
             EndsWith("/accessors/1: element 3 is 65535, the primitive restart value"));
  std::vector<float> positions = triangle_positions();
  positions[5] = std::nanf("");
  CHECK_THAT(SceneFile().error_of(document(positions, {}, 4)),
             EndsWith("/accessors/0: element 1 is not finite"));
  positions[5] = INFINITY;
  CHECK_THAT(SceneFile().error_of(document(positions, {}, 4)),
             EndsWith("/accessors/0: element 1 is not finite"));
  CHECK_THAT(SceneFile().error_of(document(triangle_positions(), {0, 1}, 5)),
             EndsWith("/meshes/0/primitives/0: 2 vertices make no whole triangles"));
  CHECK_THAT(SceneFile().error_of(document(triangle_positions(), {0, 1, 2, 0}, 4)),
             Contains("4 vertices make no whole"));
}

TEST_CASE("Values of a wrong type are not dropped") {
  CHECK_THAT(error_with("/meshes/0/primitives/0/mode", "5"),
             Contains("/mode: expected an integer from 0 to 6, found \"5\""));
  CHECK_THAT(error_with("/nodes/0/translation", {1, 2}),
             Contains("/nodes/0/translation: expected an array of 3"));
  CHECK_THAT(
      error_with("/nodes/0/scale/1", "x",
                 one_triangle().patch({{{"op", "add"}, {"path", "/nodes/0/scale"}, {"value", {1, 1, 1}}}})),
      Contains("/nodes/0/scale/1: expected a number, found \"x\""));
  CHECK_THAT(error_with("/nodes/0/mesh", -1), Contains("/nodes/0/mesh: expected an index, found -1"));
  CHECK_THAT(error_with("/nodes/0/mesh", 4294967296),
             Contains("/nodes/0/mesh: expected an index, found 4294967296"));
  CHECK_THAT(error_with("/nodes", json::object()), Contains("/nodes: expected an array"));
  CHECK_THAT(error_with("/meshes/0/primitives/0/attributes/NORMAL", "x"),
             Contains("/attributes/NORMAL: expected an index"));
  CHECK_THAT(error_with("/materials", {{{"extras", {{"pmdsim_reflectivity", 1.5}}}}}),
             Contains("/materials/0/extras/pmdsim_reflectivity: expected a number from 0 to 1, found 1.5"));
  CHECK_THAT(error_with("/materials", {{{"extras", {{"pmdsim_reflectivity", "dark"}}}}}),
             Contains("found \"dark\""));
  CHECK_THAT(error_with("/accessors/0/type", "SCALAR"),
             EndsWith("/accessors/0/type: expected \"VEC3\" for POSITION"));
  CHECK_THAT(error_with("/accessors/1/componentType", 5122, indexed()),
             EndsWith("/accessors/1/componentType: expected 5121, 5123 or 5125 for indices"));
  CHECK_THAT(error_with("/accessors/1/type", "VEC2", indexed()),
             Contains("/accessors/1/type: expected \"SCALAR\""));
  CHECK_THAT(error_with("/meshes/0/primitives/0/attributes", json::object()),
             Contains("missing key \"POSITION\""));
  CHECK_THAT(SceneFile().error_of_bytes("[]"),
             EndsWith("scene.gltf:1:1: expected an object, found an array of 0"));
  CHECK_THAT(SceneFile().error_of_bytes("{}"), EndsWith("scene.gltf:1:1: missing key \"asset\""));
  CHECK_THAT(error_with("/asset/version", "1.0"),
             EndsWith("/asset/version: expected \"2.0\", found \"1.0\""));
}

TEST_CASE("Buffers that are not in the scene's folder") {
  const SceneFile bench;
  const auto outside = [](const std::string &uri) {
    return EndsWith("/buffers/0/uri: \"" + uri +
                    "\" lies outside the scene's folder; put it there, or allow it (--allow-outside, "
                    "allow_outside in Python) where you trust the scene");
  };
  std::filesystem::create_symlink("/etc", bench.folder.path() / "link");
  std::filesystem::create_symlink("/etc/passwd", bench.folder.path() / "words.bin");
  for (const std::string uri :
       {"../../../../../../../etc/passwd", "%2e%2e/%2E%2E/etc/passwd", "..%2f..%2Fetc/passwd", "/etc/passwd",
        "%2fetc/passwd", "link/passwd", "link/../etc/passwd", "words.bin", "./words.bin"})
    CHECK_THAT(bench.error_of_uri(uri), outside(uri));
  const std::string own = (bench.folder.path() / "own.bin").string();
  CHECK_THAT(bench.error_of_uri(own), outside(own));
  std::filesystem::create_symlink("loop", bench.folder.path() / "loop");
  CHECK_THAT(bench.error_of_uri("loop"), Contains("/buffers/0/uri"));
}

TEST_CASE("Buffers and images outside of the scene's folder are read where that is allowed") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "inside");
  folder.write("own.bin", bytes_of(triangle_positions()));
  folder.write("white.png", png_bytes({1, 1, 8, 2, {255, 255, 255}}));
  json gltf = one_triangle();
  gltf["buffers"][0]["uri"] = "../own.bin";
  gltf["images"] = {{{"uri", "../white.png"}}};
  gltf["textures"] = {{{"source", 0}}};
  gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  json &primitive = gltf["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] =
      add_accessor(gltf, bytes_of(std::vector<float>(6, 0.5f)), 5126, 3, "VEC2");
  const auto scene = folder.write("inside/scene.gltf", gltf.dump());
  CHECK(load_gltf(scene, Place{scene}, UriFiles::anywhere).at(0).scene.triangles.size() == 1);
  CHECK_THAT(input_error_of([&] { load_gltf(scene, Place{scene}); }), Contains("/buffers/0/uri"));
  folder.write("inside/own.bin", bytes_of(triangle_positions()));
  gltf["buffers"][0]["uri"] = "own.bin";
  folder.write("inside/scene.gltf", gltf.dump());
  CHECK_THAT(input_error_of([&] { load_gltf(scene, Place{scene}).at(0); }), Contains("/images/0/uri"));
}

TEST_CASE("Buffers that are no files, or not those stated") {
  const SceneFile bench;
  std::filesystem::create_directory(bench.folder.path() / "parts");
  CHECK_THAT(bench.error_of_uri("parts"), EndsWith("is a directory, expected a file"));
  CHECK_THAT(bench.error_of_uri("."), EndsWith("is a directory, expected a file"));
  REQUIRE(mkfifo((bench.folder.path() / "pipe").c_str(), 0600) == 0);
  CHECK_THAT(bench.error_of_uri("pipe"), EndsWith("is no regular file"));
  CHECK_THAT(bench.error_of_uri("absent.bin"), Contains("/buffers/0/uri") && EndsWith("no such file"));
  bench.folder.write("short.bin", "1234");
  CHECK_THAT(bench.error_of_uri("short.bin"),
             Contains("/buffers/0/uri: ") && EndsWith("short.bin\": has 4 bytes, expected at least 36"));
  CHECK_THAT(bench.error_of_uri("bad%2"), Contains("expected a percent-encoded relative path"));
  CHECK_THAT(bench.error_of_uri("nul%00"), Contains("expected a percent-encoded relative path"));
  CHECK_THAT(bench.error_of_uri("data:text/html,hello"), Contains("expected a base64 data URI of 36 bytes"));
  CHECK_THAT(bench.error_of_uri(data_uri("1234")), Contains("expected a base64 data URI of 36 bytes"));
  CHECK_THAT(bench.error_of_uri(""), EndsWith("/buffers/0: missing key \"uri\""));
}

TEST_CASE("Buffers that are somewhere else") {
  const SceneFile bench;
  for (const std::string uri : {"http://x/y", "file:///etc/passwd", "C:own.bin", "DATA:,x", "git+ssh://x"})
    CHECK_THAT(
        bench.error_of_uri(uri),
        EndsWith("/buffers/0/uri: expected a relative file name or a data: URI, found \"" + uri + "\""));
  for (const std::string uri : {"./a:b.bin", "own%3A.bin", "1:1.bin"})
    CHECK_THAT(bench.error_of_uri(uri), EndsWith("no such file"));
}

TEST_CASE("All buffers together have a limit") {
  const auto error_of_second = [](std::size_t length_bytes) {
    json gltf = one_triangle();
    gltf["buffers"].push_back({{"byteLength", length_bytes}, {"uri", "absent.bin"}});
    return SceneFile().error_of(gltf);
  };
  const std::size_t left_bytes = (std::size_t{1} << 30) - 36;
  CHECK_THAT(error_of_second(left_bytes + 1),
             EndsWith("/buffers/1/byteLength: expected at most 1073741824 bytes in all buffers"));
  CHECK_THAT(error_of_second(left_bytes), EndsWith("no such file"));
}

TEST_CASE("No more of a buffer's file is read than the buffer has") {
  const SceneFile bench;
  const std::string positions = bytes_of(triangle_positions());
  const auto file = bench.folder.write("own.bin", positions);
  std::filesystem::resize_file(file, std::uintmax_t{1} << 31); // sparse
  json gltf = one_triangle();
  gltf["buffers"][0]["uri"] = "own.bin";
  const auto scene = bench.folder.write("scene.gltf", gltf.dump());
  CHECK(load_gltf(scene, Place{scene}).at(0).scene.triangles.size() == 1);
}

TEST_CASE("Text that is too deep or broken") {
  const SceneFile bench;
  CHECK_THAT(bench.error_of_bytes(R"({"asset": {"version": "2.0"}, "extras": )" + std::string(20'000, '[')),
             Contains("nested too deep"));
  CHECK_THAT(bench.error_of_bytes("{\n\"asset\" 1}"), Contains("scene.gltf:2:9: not valid JSON"));
  CHECK_THAT(bench.error_of_bytes("// comment\n{}"), Contains("scene.gltf:1:1: not valid JSON"));
}

TEST_CASE("A .glb whose header or chunks are wrong") {
  const SceneFile bench;
  const std::string good = glb(one_triangle(), bytes_of(triangle_positions()));
  const auto with_byte = [&](std::size_t offset, char byte) {
    std::string bytes = good;
    bytes[offset] = byte;
    return bytes;
  };
  CHECK_THAT(bench.error_of_bytes("glTF"), Contains("expected a .glb header of version 2"));
  CHECK_THAT(bench.error_of_bytes(with_byte(4, 1)), Contains("expected a .glb header of version 2"));
  CHECK_THAT(bench.error_of_bytes(good + "more"), Contains("the .glb header tells"));
  CHECK_THAT(bench.error_of_bytes(with_byte(15, '\x7f')), Contains("a .glb chunk is cut short, expected"));
  CHECK_THAT(bench.error_of_bytes(with_byte(16, 'B')), Contains("expected JSON as the first .glb chunk"));
  CHECK_THAT(bench.error_of_bytes(glb(one_triangle(), "1234")),
             EndsWith("/buffers/0: expected 36 bytes, found 4"));
}
