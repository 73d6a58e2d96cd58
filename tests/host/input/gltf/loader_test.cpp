#include "host/input/gltf/loader.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

GltfScene load_bytes(const std::string &bytes, const std::string &name = "scene.gltf") {
  const TemporaryFolder folder;
  const auto file = folder.write(name, bytes);
  return load_gltf(file, Place{file}).at(0);
}

// Five points along a zigzag from left to right, in the order that a strip takes them.
const std::vector<float> zigzag = {0, 0, 0, 1, 1, 0, 2, 0, 0, 3, 1, 0, 4, 0, 0};

glm::dvec3 normal_of(const Scene &scene, const Triangle &triangle) {
  const auto corner = [&](std::size_t i) { return scene.positions_m[triangle.vertices[i]]; };
  return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

} // namespace

TEST_CASE("Triangles, strips and fans, plain and indexed") {
  CHECK(vertices_of(scene_of(document(triangle_positions(), {}, 4))) == Ids{{0, 1, 2}});
  CHECK(vertices_of(scene_of(document(zigzag, {0, 2, 1, 2, 4, 3}, 4))) == Ids{{0, 2, 1}, {2, 4, 3}});
  CHECK(vertices_of(scene_of(document(zigzag, {}, 5))) == Ids{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}});
  CHECK(vertices_of(scene_of(document(zigzag, {4, 3, 2, 1}, 5))) == Ids{{4, 3, 2}, {3, 1, 2}});
  CHECK(vertices_of(scene_of(document(zigzag, {}, 6))) == Ids{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}});
  CHECK(vertices_of(scene_of(document(zigzag, {1, 0, 2, 3}, 6))) == Ids{{0, 2, 1}, {2, 3, 1}});
}

TEST_CASE("A strip's triangles all show the same side") {
  const Scene scene = scene_of(document(zigzag, {}, 5));
  for (const Triangle &triangle : scene.triangles)
    CHECK(normal_of(scene, triangle).z == Approx(-1.0));
}

TEST_CASE("Triangles without an area stay, so that ids count what the file holds") {
  // Two triangles, stitched by repeated vertices.
  CHECK(vertices_of(scene_of(document(zigzag, {0, 1, 2, 2, 2, 3, 4}, 5))).size() == 5);
  CHECK(vertices_of(scene_of(document(zigzag, {0, 0, 1, 0, 1, 2}, 4))) == Ids{{0, 0, 1}, {0, 1, 2}});
}

TEST_CASE("Indices of 8, 16 and 32 bit") {
  const auto with_indices = [](const std::string &bytes, int component_type) {
    json gltf = document(zigzag, {0, 2, 1}, 4);
    gltf["accessors"][1]["componentType"] = component_type;
    gltf["bufferViews"][1] = {{"buffer", 1}, {"byteLength", bytes.size()}};
    gltf["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
    return vertices_of(scene_of(gltf));
  };
  CHECK(with_indices(bytes_of<std::uint8_t>({0, 2, 1}), 5121) == Ids{{0, 2, 1}});
  CHECK(with_indices(bytes_of<std::uint16_t>({0, 2, 1}), 5123) == Ids{{0, 2, 1}});
  CHECK(with_indices(bytes_of<std::uint32_t>({0, 2, 1}), 5125) == Ids{{0, 2, 1}});
}

TEST_CASE("Offsets and strides of interleaved vertices") {
  // An unused float before each position.
  const std::vector<float> interleaved = {9, -1, -1, -1, 9, 1, -1, -1, 9, 0, 1, -1};
  json gltf = one_triangle();
  gltf["buffers"][0] = {{"byteLength", 48}, {"uri", data_uri(bytes_of(interleaved))}};
  gltf["bufferViews"][0] = {{"buffer", 0}, {"byteLength", 48}, {"byteStride", 16}};
  gltf["accessors"][0]["byteOffset"] = 4;
  CHECK(scene_of(gltf).positions_m == scene_of(one_triangle()).positions_m);
}

TEST_CASE("A .glb, a .gltf with a file beside it and one with a data URI are the same scene") {
  const std::string bytes = bytes_of(triangle_positions());
  const auto expected = scene_of(one_triangle()).positions_m;
  CHECK(expected[2] == glm::dvec3(0, 1, -1));
  CHECK(load_bytes(glb(one_triangle(), bytes), "scene.glb").scene.positions_m == expected);

  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "parts");
  folder.write("parts/a b.bin", bytes);
  json gltf = one_triangle();
  gltf["buffers"][0]["uri"] = "parts/../parts/a%20b.bin";
  const auto file = folder.write("scene.gltf", gltf.dump());
  CHECK(load_gltf(file, Place{file}).at(0).scene.positions_m == expected);
}

TEST_CASE("Reflectivity is the base colour's luminance or what extras give") {
  json gltf = one_triangle();
  const auto surface = [&](const json &material) {
    gltf["materials"] = {material};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    return scene_of(gltf).surfaces.at(0);
  };
  CHECK(scene_of(one_triangle()).surfaces.at(0).reflectivity == 1.0);
  CHECK_FALSE(scene_of(one_triangle()).surfaces.at(0).double_sided);
  CHECK(surface({{"doubleSided", true}}).double_sided);
  CHECK(surface({{"doubleSided", true}}).reflectivity == Approx(1.0));
  const json colour = {{"baseColorFactor", {0.5, 0.25, 1.0, 1.0}}};
  CHECK(surface({{"pbrMetallicRoughness", colour}}).reflectivity ==
        Approx(0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722 * 1.0).epsilon(1e-15));
  CHECK(surface({{"pbrMetallicRoughness", colour}, {"extras", {{"pmdsim_reflectivity", 0.125}}}})
            .reflectivity == 0.125);
  CHECK(surface({{"extras", {{"pmdsim_reflectivity", 0}}}}).reflectivity == 0.0);
}

TEST_CASE("Objects are the nodes that carry a mesh") {
  json gltf = one_triangle();
  gltf["nodes"] = {{{"name", "left"}, {"mesh", 0}}, {{"name", "empty"}}, {{"mesh", 0}}};
  gltf["scenes"][0]["nodes"] = {0, 1, 2};
  const GltfScene loaded = load_bytes(gltf.dump());
  CHECK(loaded.scene.objects == std::vector<std::string>{"left", "node 2"});
  REQUIRE(loaded.scene.triangles.size() == 2);
  CHECK(loaded.scene.triangles[1].object == 1);
  CHECK(loaded.scene.triangles[1].vertices[0] == 3);
  CHECK(loaded.scene.surfaces.size() == 1);
  REQUIRE(loaded.nodes.size() == 2);
  CHECK(loaded.nodes[1].name == "empty");
}

TEST_CASE("Objects and triangles count from the scene's root nodes on, level by level") {
  json gltf = one_triangle();
  gltf["nodes"] = {{{"name", "child"}, {"mesh", 0}},
                   {{"name", "group"}, {"children", {0, 3}}},
                   {{"name", "root"}, {"mesh", 0}},
                   {{"name", "parent"}, {"mesh", 0}, {"children", {4}}},
                   {{"name", "grandchild"}, {"mesh", 0}}};
  gltf["scenes"][0]["nodes"] = {1, 2};
  const Scene scene = load_bytes(gltf.dump()).scene;
  CHECK(scene.objects == std::vector<std::string>{"root", "child", "parent", "grandchild"});
  REQUIRE(scene.triangles.size() == 4);
  for (std::uint32_t i = 0; i < 4; ++i)
    CHECK(scene.triangles[i].object == i);
}

TEST_CASE("An empty scene loads") {
  CHECK(scene_of({{"asset", {{"version", "2.0"}}}}).triangles.empty());
  CHECK(scene_of({{"asset", {{"version", "2.0"}}}, {"scenes", {json::object()}}}).triangles.empty());
}

TEST_CASE("Images that no material needs are not looked at") {
  json gltf = one_triangle();
  gltf["images"] = {{{"uri", "../../../../../../etc/passwd"}}, {{"uri", "absent.png"}}, {{"bufferView", 0}}};
  gltf["textures"] = {{{"source", 0}}};
  CHECK(scene_of(gltf).triangles.size() == 1);
}
