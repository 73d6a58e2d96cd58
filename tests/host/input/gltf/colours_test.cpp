// Vertex colours and texture coordinates beside the positions.

#include "host/input/gltf/mesh/mesh.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"

#include <catch2/catch.hpp>
#include <tiny_gltf.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::EndsWith;
using nlohmann::json;

namespace {

using Colours = std::vector<glm::vec4>;

json coloured(const std::string &bytes, int component_type, const std::string &type) {
  json gltf = one_triangle();
  const std::size_t accessor = add_accessor(gltf, bytes, component_type, 3, type);
  gltf["accessors"][accessor]["normalized"] = component_type != 5126;
  gltf["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
  return gltf;
}

// A triangle with TEXCOORD_1, without a file.
struct TexturedTriangle {
  tinygltf::Model model;
  tinygltf::Primitive primitive;
  GltfMaterial material;

  explicit TexturedTriangle(const std::vector<float> &coordinates) {
    add("POSITION", triangle_positions(), 3, TINYGLTF_TYPE_VEC3);
    add("TEXCOORD_1", coordinates, 3, TINYGLTF_TYPE_VEC2);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    material.surface.paint = Paint{.texture = std::make_shared<Texture>()};
    material.texture_coordinates = 1;
  }

  template <class T>
  tinygltf::Accessor &add(const std::string &name, const std::vector<T> &components, std::size_t count,
                          int type) {
    const std::string bytes = bytes_of(components);
    const int index = static_cast<int>(model.accessors.size());
    model.buffers.emplace_back().data.assign(bytes.begin(), bytes.end());
    tinygltf::BufferView &view = model.bufferViews.emplace_back();
    view.buffer = index;
    view.byteLength = bytes.size();
    tinygltf::Accessor &accessor = model.accessors.emplace_back();
    accessor.bufferView = index;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.count = count;
    accessor.type = type;
    primitive.attributes[name] = index;
    return accessor;
  }

  void append_to(Scene &scene) const {
    std::size_t shapes = 0;
    append_primitive({model, primitive, Place{"scene.gltf"} / "meshes" / 0 / "primitives" / 0},
                     {Placement(AffineTransform{}), material, 0, 0}, shapes, scene);
  }
  std::vector<glm::dvec2> coordinates() const {
    Scene scene;
    append_to(scene);
    return scene.texture_coordinates;
  }
  std::string error() const {
    return input_error_of([&] { coordinates(); });
  }
};

} // namespace

TEST_CASE("Vertex colours of 8 and 16 bit and float, with alpha and without") {
  CHECK(
      scene_of(coloured(bytes_of<float>({1, 0.5, 0, 0.25, 0, 0, 0, 1, 0, 0, 0, 1}), 5126, "VEC4")).colours ==
      Colours{{1, 0.5, 0, 0.25}, {0, 0, 0, 1}, {0, 0, 0, 1}});
  CHECK(scene_of(coloured(bytes_of<float>({1, 0.5, 0, 0.25, 0, 0, 0, 1, 0}), 5126, "VEC3")).colours ==
        Colours{{1, 0.5, 0, 1}, {0.25, 0, 0, 1}, {0, 1, 0, 1}});
  CHECK(scene_of(coloured(bytes_of<std::uint8_t>({255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0}), 5121, "VEC4"))
            .colours.at(0) == glm::vec4(1, 0, 0.2, 1));
  json gltf = coloured(bytes_of<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5123, "VEC3");
  gltf["bufferViews"].back()["byteStride"] = 8;
  CHECK(scene_of(gltf).colours.at(0) == glm::vec4(1, 0, 0.2, 1));
}

TEST_CASE("Vertex colours are clamped to what light can be") {
  CHECK(scene_of(coloured(bytes_of<float>({2, -1, 0.5, 0, 0, 0, 0, 0, 0}), 5126, "VEC3")).colours.at(0) ==
        glm::vec4(1, 0, 0.5, 1));
}

TEST_CASE("What has no vertex colours is white beside what has, and another surface") {
  json gltf = coloured(bytes_of<float>({1, 0.5, 0, 0.25, 0, 0, 0, 1, 0}), 5126, "VEC3");
  const json plain = {{"attributes", {{"POSITION", 0}}}};
  json &primitives = gltf["meshes"][0]["primitives"];
  primitives = {plain, primitives[0], plain, primitives[0]};
  const Scene scene = scene_of(gltf);
  REQUIRE(scene.colours.size() == scene.positions_m.size());
  CHECK(scene.colours.at(2) == glm::vec4(1));
  CHECK(scene.colours.at(3) == glm::vec4(1, 0.5, 0, 1));
  CHECK(scene.colours.at(6) == glm::vec4(1));
  CHECK(scene.colours.at(11) == glm::vec4(0, 1, 0, 1));
  CHECK(scene.surfaces.size() == 2);
  CHECK_FALSE(scene.surfaces.at(scene.triangles.at(2).surface).paint);
  REQUIRE(scene.surfaces.at(scene.triangles.at(3).surface).paint);
  CHECK(scene.texture_coordinates.empty());
}

TEST_CASE("Translucent vertex colours are refused under BLEND") {
  const auto blended = [](float alpha) {
    json gltf = coloured(bytes_of<float>({1, 1, 1, 1, 1, 1, 1, alpha, 1, 1, 1, 1}), 5126, "VEC4");
    gltf["materials"] = {{{"alphaMode", "BLEND"}}};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    return gltf;
  };
  CHECK_NOTHROW(scene_of(blended(1.0f)));
  CHECK_THAT(input_error_of([&] { scene_of(blended(0.9f)); }),
             Catch::Contains("/meshes/0/primitives/0/attributes/COLOR_0: an alpha below 1 is not supported"));
}

TEST_CASE("A scene without vertex colours holds none") { CHECK(scene_of(one_triangle()).colours.empty()); }

TEST_CASE("Points have colours too") {
  json gltf = coloured(bytes_of<float>({1, 0.5, 0, 0.25, 0, 0, 0, 1, 0}), 5126, "VEC3");
  gltf["materials"] = {{{"extras", {{"pmdsim_point_area_m2", 0.01}}}}};
  gltf["meshes"][0]["primitives"][0]["mode"] = 0;
  gltf["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene scene = scene_of(gltf);
  CHECK(scene.colours.at(scene.discs.at(2).vertex) == glm::vec4(0, 1, 0, 1));
}

TEST_CASE("Vertex colours of another type or number are refused") {
  const std::string bytes = bytes_of<float>({1, 0.5, 0, 0.25, 0, 0, 0, 1, 0});
  json gltf = coloured(bytes, 5126, "VEC2");
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1/type: expected \"VEC3\" or \"VEC4\" for COLOR_0"));
  gltf = coloured(bytes, 5126, "VEC3");
  gltf["accessors"][1]["count"] = 2;
  CHECK_THAT(scene_error_of(gltf),
             EndsWith("/meshes/0/primitives/0/attributes/COLOR_0: has 2 elements, POSITION has 3"));
  const std::string expected =
      "/accessors/1/componentType: expected 5126, or normalized 5121 or 5123, for COLOR_0";
  CHECK_THAT(scene_error_of(coloured(bytes, 5122, "VEC3")), EndsWith(expected));
  gltf = coloured(bytes, 5121, "VEC3");
  gltf["accessors"][1]["normalized"] = false;
  CHECK_THAT(scene_error_of(gltf), EndsWith(expected));
}

TEST_CASE("Texture coordinates are those that the material asks for, transformed as it says") {
  TexturedTriangle textured({0.5, 0.25, 1, 0, 0, 1});
  CHECK(textured.coordinates() == std::vector<glm::dvec2>{{0.5, 0.25}, {1, 0}, {0, 1}});
  textured.material.texture_from_coordinates = glm::dmat3(2, 0, 0, 0, -1, 0, 0.5, 3, 1);
  CHECK(textured.coordinates() == std::vector<glm::dvec2>{{1.5, 2.75}, {2.5, 3}, {0.5, 2}});
  textured.material.surface.paint->texture = nullptr;
  CHECK(textured.coordinates().empty());
}

TEST_CASE("What has no texture lies at (0, 0) beside what has") {
  const TexturedTriangle textured({0.5, 0.25, 1, 0, 0, 1});
  TexturedTriangle plain = textured;
  plain.material.surface.paint.reset();
  Scene scene;
  plain.append_to(scene);
  CHECK(scene.texture_coordinates.empty());
  textured.append_to(scene);
  plain.append_to(scene);
  REQUIRE(scene.texture_coordinates.size() == 9);
  CHECK(scene.texture_coordinates[2] == glm::dvec2(0));
  CHECK(scene.texture_coordinates[3] == glm::dvec2(0.5, 0.25));
  CHECK(scene.texture_coordinates[8] == glm::dvec2(0));
}

TEST_CASE("Quantized texture coordinates") {
  TexturedTriangle textured({0.5, 0.25, 1, 0, 0, 1});
  tinygltf::Accessor &accessor =
      textured.add<std::uint16_t>("TEXCOORD_1", {0, 65535, 13107, 1, 2, 3}, 3, TINYGLTF_TYPE_VEC2);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  accessor.normalized = true; // glTF 2.0 without an extension
  CHECK(textured.coordinates().at(0) == glm::dvec2(0, 1));
  accessor.normalized = false;
  CHECK_THAT(textured.error(), EndsWith("/accessors/2/componentType: 5123 is not allowed for TEXCOORD_1 "
                                        "without the extension KHR_mesh_quantization"));
  textured.model.extensionsUsed = {"KHR_mesh_quantization"};
  CHECK(textured.coordinates().at(0) == glm::dvec2(0, 65535));
}

TEST_CASE("Texture coordinates that are missing or beyond any texture are refused") {
  TexturedTriangle textured({0.5, 0.25, 1, 0, 0, 1});
  textured.material.texture_coordinates = 2;
  CHECK_THAT(textured.error(),
             EndsWith("/meshes/0/primitives/0/attributes: missing key \"TEXCOORD_2\", which "
                      "its material's texture needs"));
  textured.material.texture_coordinates = 1;
  textured.model.accessors[1].count = 2;
  CHECK_THAT(textured.error(),
             EndsWith("/primitives/0/attributes/TEXCOORD_1: has 2 elements, POSITION has 3"));
  CHECK_THAT(TexturedTriangle({0, 0, 0, 1e7f, 0, 1}).error(),
             EndsWith("/meshes/0/primitives/0: vertex 1 lies outside the texture, expected coordinates from "
                      "-1000000 to 1000000"));
  TexturedTriangle endless({0, 0, 1, 0, 0, 1});
  endless.material.texture_from_coordinates[0][0] = std::numeric_limits<double>::infinity();
  CHECK_THAT(endless.error(), EndsWith("expected coordinates from -1000000 to 1000000"));
}
