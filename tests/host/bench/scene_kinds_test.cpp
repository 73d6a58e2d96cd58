// The procedural scenes of `bench --suite`: what every kind keeps, and what the awkward ones are for.

#include "host/bench/real/scene_files.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>

using namespace pmdsim;

namespace {

constexpr std::uint32_t few = 2000, many = 30000;

using Place = std::tuple<double, double, double>;
using Edge = std::pair<Place, Place>;

Place place(const Scene &scene, std::uint32_t vertex) {
  const glm::dvec3 &at = scene.positions_m[vertex];
  return {at.x, at.y, at.z};
}

glm::dvec3 area_vector(const Scene &scene, const Triangle &triangle) {
  const auto &[a, b, c] = triangle.vertices;
  return glm::cross(scene.positions_m[b] - scene.positions_m[a], scene.positions_m[c] - scene.positions_m[a]);
}

// How many triangles of an object run along each edge, between places rather than vertices.
std::map<Edge, int> edges_of(const Scene &scene, const std::string &object) {
  std::map<Edge, int> edges;
  for (const Triangle &triangle : scene.triangles)
    if (scene.objects[triangle.object] == object)
      for (std::size_t i = 0; i < 3; ++i)
        ++edges[{place(scene, triangle.vertices[i]), place(scene, triangle.vertices[(i + 1) % 3])}];
  return edges;
}

bool is_closed(const std::map<Edge, int> &edges) {
  return !edges.empty() && std::ranges::all_of(edges, [&](const auto &edge) {
    const auto back = edges.find({edge.first.second, edge.first.first});
    return back != edges.end() && back->second == edge.second;
  });
}

// Above 0 where fronts are outside.
double volume(const Scene &scene, const std::string &object) {
  double sum = 0.0;
  for (const Triangle &triangle : scene.triangles)
    if (scene.objects[triangle.object] == object)
      sum += glm::dot(area_vector(scene, triangle), scene.positions_m[triangle.vertices[0]]) / 6.0;
  return sum;
}

double nearest_depth_m(const Scene &scene) {
  double nearest_m = 1e9;
  for (const Triangle &triangle : scene.triangles)
    for (const std::uint32_t vertex : triangle.vertices)
      nearest_m = std::min(nearest_m, -scene.positions_m[vertex].z);
  return nearest_m;
}

Scene made(const char *kind, std::uint32_t triangles = few) { return find_kind(kind)->make(triangles); }

} // namespace

TEST_CASE("every kind of scene has about the triangles asked for, all sound") {
  for (const SceneKind &kind : scene_kinds())
    for (const std::uint32_t triangles : {few, many}) {
      INFO(kind.name << ", " << triangles);
      const Scene scene = kind.make(triangles);
      // With few triangles a whole number of parts may be far off.
      CHECK(static_cast<double>(scene.triangles.size()) ==
            Approx(triangles).epsilon(triangles == few ? 0.4 : 0.1));
      REQUIRE(scene.objects.size() == scene.surfaces.size());
      CHECK(std::ranges::all_of(scene.positions_m, [](const glm::dvec3 &position_m) { // as float32 holds them
        return glm::length(position_m) < 8.0 && glm::fract(0x1p21 * position_m) == glm::dvec3(0.0);
      }));
      CHECK(std::ranges::all_of(scene.triangles, [&](const Triangle &triangle) {
        return triangle.surface < scene.surfaces.size() &&
               std::ranges::max(triangle.vertices) < scene.positions_m.size() &&
               glm::length(area_vector(scene, triangle)) > 0.0;
      }));
    }
}

TEST_CASE("a kind of scene is the same every time") {
  for (const SceneKind &kind : scene_kinds()) {
    INFO(kind.name);
    const Scene one = kind.make(few), other = kind.make(few);
    CHECK(one.positions_m == other.positions_m);
    CHECK(std::ranges::equal(one.triangles, other.triangles, {}, &Triangle::vertices, &Triangle::vertices));
  }
}

TEST_CASE("bodies are closed and show their fronts") {
  for (const auto &[kind, object] :
       std::array<std::pair<const char *, const char *>, 10>{{{"blob", "body"},
                                                              {"knot", "knot"},
                                                              {"scan", "body"},
                                                              {"head", "body"},
                                                              {"lattice", "rods"},
                                                              {"forest", "trees"},
                                                              {"crowd", "figures"},
                                                              {"room", "balls"},
                                                              {"touching", "piles"},
                                                              {"piercing", "rods"}}}) {
    INFO(kind << ": " << object);
    const Scene scene = made(kind);
    CHECK(is_closed(edges_of(scene, object)));
    CHECK(volume(scene, object) > 0.0);
  }
}

TEST_CASE("awkward scenes are what they are for") {
  const auto fans = edges_of(made("fans"), "fans");
  CHECK(std::ranges::count_if(fans, [](const auto &edge) { return edge.second == 16; }) == 2000 / 16);
  CHECK_FALSE(is_closed(edges_of(made("flipped"), "body")));
  CHECK(nearest_depth_m(made("close")) == Approx(0.2).margin(0.03));
  CHECK(nearest_depth_m(made("piercing")) < -0.1);

  const Scene needles = made("needles");
  for (const Triangle &triangle : needles.triangles)
    if (needles.objects[triangle.object] == "needles")
      REQUIRE(glm::length(area_vector(needles, triangle)) == Approx(2.0 * 6e-3).epsilon(1e-4));

  int inside = 0,
      beside = 0; // of rods where they pass the diodes' plane, the outermost of which are at 0.166 m
  const Scene piercing = made("piercing");
  for (const auto &[edge, count] : edges_of(piercing, "rods")) {
    const auto &[x, y, z] = edge.first;
    if (z > 0.0)
      ++(std::hypot(x, y) < 0.126 ? inside : beside);
  }
  CHECK(inside > 0);
  CHECK(beside > 0);
}

TEST_CASE("a scene's files are read as what was written") {
  const test::TemporaryFolder folder;
  const Setup written = setup_of_kind(*find_kind("blades"), few, 32);
  const Setup read = load_setup(write_scene_files(folder.path() / "new", "grass", written).setup);
  const Instant &from = written.start, &to = read.start;
  REQUIRE(to.scene.triangles.size() == from.scene.triangles.size());
  for (std::size_t i = 0; i < from.scene.triangles.size(); ++i) {
    const Triangle &one = from.scene.triangles[i], &other = to.scene.triangles[i];
    for (std::size_t corner = 0; corner < 3; ++corner)
      REQUIRE(place(from.scene, one.vertices[corner]) == place(to.scene, other.vertices[corner]));
    const Surface &surface = from.scene.surfaces[one.surface],
                  &other_surface = to.scene.surfaces[other.surface];
    REQUIRE(surface.double_sided == other_surface.double_sided);
    REQUIRE(surface.reflectivity == Approx(other_surface.reflectivity).epsilon(1e-12));
  }
  CHECK(read.backscatter == written.backscatter);
  CHECK(read.shadows == written.shadows);
  const Sensor &sensor = to.sensors.front();
  CHECK(sensor.resolution == glm::uvec2(32));
  CHECK(sensor.pixel_pitch_m.x * sensor.resolution.x / (2.0 * sensor.focal_length_m) ==
        Approx(half_view_tangent));
  REQUIRE(to.illuminators.front().diodes.size() == 240);
  for (std::size_t i = 0; i < 240; ++i) {
    const Diode &one = from.illuminators.front().diodes[i], &other = to.illuminators.front().diodes[i];
    REQUIRE(one.position_m == other.position_m);
    REQUIRE(other.pattern.kind == Pattern::Kind::cosine);
    REQUIRE(other.pattern.order == 3.0);
  }
}
