// Points become discs with a radius in the world.

#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/gltf/loaded_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// Three points, "object" on node 0; nothing gives their size yet.
json points(const std::vector<std::uint16_t> &indices = {}) {
  return document(triangle_positions(), indices, 0);
}

json with_radii(const std::vector<float> &radii, json gltf = points()) {
  const std::size_t accessor = add_accessor(gltf, bytes_of(radii), 5126, radii.size(), "SCALAR");
  gltf["meshes"][0]["primitives"][0]["attributes"]["_RADIUS"] = accessor;
  return gltf;
}

json with_area(double area_m2, json gltf = points()) {
  gltf["materials"] = {{{"extras", {{"pmdsim_point_area_m2", area_m2}}}}};
  gltf["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

std::vector<double> radii_of(const json &gltf) {
  std::vector<double> radii;
  for (const Disc &disc : scene_of(gltf).discs)
    radii.push_back(disc.radius_m);
  return radii;
}

} // namespace

TEST_CASE("Each point is a disc at its vertex, of its own radius") {
  const Scene scene = scene_of(with_radii({0.5f, 0.25f, 2.0f}));
  CHECK(scene.triangles.empty());
  REQUIRE(scene.discs.size() == 3);
  CHECK(scene.positions_m.at(scene.discs[1].vertex) == glm::dvec3(1, -1, -1));
  CHECK(scene.discs[1].radius_m == 0.25);
  CHECK(scene.discs[2].radius_m == 2.0);
  CHECK(scene.objects.at(scene.discs[2].object) == "object");
  CHECK(scene.surfaces.at(scene.discs[2].surface).reflectivity == 1.0);
}

TEST_CASE("A material gives its points an area, but their own radius goes first") {
  for (const double radius : radii_of(with_area(0.01)))
    CHECK(radius == Approx(std::sqrt(0.01 / std::numbers::pi)).epsilon(1e-15));
  CHECK(radii_of(with_radii({1, 2, 3}, with_area(0.01))) == std::vector<double>{1, 2, 3});
}

TEST_CASE("Indices choose points") {
  const Scene scene = scene_of(with_radii({1, 2, 3}, points({2, 0})));
  REQUIRE(scene.discs.size() == 2);
  CHECK(scene.discs[0].vertex == 2);
  CHECK(scene.discs[0].radius_m == 3);
  CHECK(scene.discs[1].vertex == 0);
  CHECK(scene.positions_m.size() == 3);
}

TEST_CASE("A node scales radii by the cube root of its change of volume") {
  json gltf = with_radii({1, 2, 3});
  gltf["nodes"][0]["scale"] = {-1, 2, 4};
  CHECK(radii_of(gltf).at(2) == Approx(6).epsilon(1e-15));
  gltf = with_area(std::numbers::pi);
  gltf["nodes"][0]["scale"] = {3, 3, 3};
  CHECK(radii_of(gltf).at(2) == Approx(3).epsilon(1e-15));
}

TEST_CASE("An area is one in the world where positions are quantized") {
  json gltf = with_area(std::numbers::pi);
  const std::size_t accessor = add_accessor(
      gltf, bytes_of<std::uint16_t>({0, 0, 0, 0, 1000, 0, 0, 0, 0, 1000, 0, 0}), 5123, 3, "VEC3");
  gltf["bufferViews"].back()["byteStride"] = 8;
  gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
  gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
  gltf["nodes"][0]["scale"] = {0.001, 0.001, 0.001};
  CHECK(radii_of(gltf) == std::vector<double>(3, 1.0));
}

TEST_CASE("Points scaled to nothing are not there") {
  json gltf = with_radii({1, 2, 3});
  gltf["nodes"][0]["scale"] = {0, 0, 0};
  CHECK(radii_of(gltf).empty());
}

TEST_CASE("Points and triangles of one mesh are one object") {
  json gltf = one_triangle();
  gltf["materials"] = {{{"extras", {{"pmdsim_point_area_m2", 1}}}}};
  gltf["meshes"][0]["primitives"].push_back(
      {{"attributes", {{"POSITION", 0}}}, {"mode", 0}, {"material", 0}});
  const Scene scene = scene_of(gltf);
  CHECK(scene.shape_count() == 4);
  CHECK(scene.discs.at(0).vertex == 3);
  CHECK(scene.object_of(1) == scene.object_of(0));
  CHECK(scene.surface_of(1) == 1);
}

TEST_CASE("Points whose size is missing or none are refused") {
  CHECK_THAT(scene_error_of(points()), EndsWith("/meshes/0/primitives/0: points without a size, expected the "
                                                "attribute _RADIUS or a material with "
                                                "extras.pmdsim_point_area_m2"));
  CHECK_THAT(scene_error_of(with_radii({1, 0, 3})),
             EndsWith("/accessors/1: element 1 is 0, expected a radius above 0"));
  CHECK_THAT(scene_error_of(with_radii({1, 2, -3})),
             EndsWith("/accessors/1: element 2 is -3, expected a radius above 0"));
  CHECK_THAT(scene_error_of(with_radii({1, NAN, 3})), EndsWith("/accessors/1: element 1 is not finite"));
  CHECK_THAT(scene_error_of(with_radii({1, 2})),
             EndsWith("/meshes/0/primitives/0/attributes/_RADIUS: has 2 elements, POSITION has 3"));
  CHECK_THAT(scene_error_of(with_radii({1, 2, 3e9f})),
             EndsWith("/meshes/0/primitives/0: vertex 2 has a radius of 3000000000 m, expected at most "
                      "1000000000 m"));
  CHECK_THAT(
      scene_error_of(with_area(0)),
      EndsWith("/materials/0/extras/pmdsim_point_area_m2: expected a number above 0 and at most 1e+18, "
               "found 0"));
  CHECK_THAT(scene_error_of(with_area(-1)), Contains("/pmdsim_point_area_m2: expected a number above 0"));
  json gltf = with_radii({1, 2, 3});
  gltf["accessors"][1]["type"] = "VEC3";
  CHECK_THAT(scene_error_of(gltf), EndsWith("/accessors/1/type: expected \"SCALAR\" for _RADIUS"));
  CHECK_THAT(scene_error_of(with_radii({1, 2, 3}, points({0, 3}))),
             EndsWith("/accessors/1: element 1 is vertex 3, expected one below 3"));
}

TEST_CASE("Points that are too small to be there count as others do") {
  constexpr std::size_t most = std::size_t{1} << 25, indices = std::size_t{1} << 15;
  json gltf = with_area(1e-30, points(std::vector<std::uint16_t>(indices, 0)));
  const json node = gltf["nodes"][0];
  gltf["nodes"] = json::array();
  for (std::size_t i = 0; i <= most / indices; ++i) {
    gltf["nodes"].push_back(node);
    gltf["scenes"][0]["nodes"].push_back(i);
  }
  gltf["scenes"][0]["nodes"].erase(0);
  CHECK_THAT(scene_error_of(gltf), Contains("more than 33554432 vertices, triangles or points"));
}
