// Files that gltfpack 0.18 made of plain.gltf are the plain file's scene to the precision of their
// quantization. Made with "gltfpack -i plain.gltf -kn -ke" and
//   quantized: nothing more; compressed_more: -cc; normalized: -vpn -c; floats: -noq -cc;
//   with_fallback: -cf, whose fallback buffer's file is not there, as nothing needs it.

#include "host/input/gltf/loader.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace pmdsim;

namespace {

struct Corner {
  glm::dvec3 position_m;
  glm::vec4 colour;
};

using Corners = std::array<Corner, 3>;

Scene load_packed(const std::string &name) {
  const auto file = std::filesystem::path(PMDSIM_TEST_FILES) / "packed" / name;
  return load_gltf(file, Place{file}).at(0).scene;
}

std::vector<Corners> triangles_of(const Scene &scene) {
  std::vector<Corners> triangles;
  for (const Triangle &triangle : scene.triangles) {
    Corners &corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = {scene.positions_m[triangle.vertices[k]], scene.colours.at(triangle.vertices[k])};
  }
  return triangles;
}

// A packed triangle may begin with another corner.
double distance(const Corners &a, const Corners &b, std::size_t first) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max(largest, glm::length(a[k].position_m - b[(k + first) % 3].position_m));
  return largest;
}

float colour_difference(const Corners &a, const Corners &b, std::size_t first) {
  float largest = 0.0f;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max(largest, glm::length(a[k].colour - b[(k + first) % 3].colour));
  return largest;
}

struct Match {
  double distance_m = std::numeric_limits<double>::infinity();
  float colour_difference = 0.0f;
};

Match nearest(const Corners &triangle, const std::vector<Corners> &others) {
  Match best;
  for (const Corners &other : others)
    for (std::size_t first = 0; first < 3; ++first)
      if (const double d = distance(triangle, other, first); d < best.distance_m)
        best = {d, colour_difference(triangle, other, first)};
  return best;
}

void check_each_has_its_like(const std::vector<Corners> &triangles, const std::vector<Corners> &others,
                             double largest_m) {
  for (const Corners &triangle : triangles) {
    const Match match = nearest(triangle, others);
    REQUIRE(match.distance_m <= largest_m);
    REQUIRE(match.colour_difference < 1e-6f);
  }
}

void check_discs(const Scene &packed, const Scene &plain, double largest_m) {
  REQUIRE(packed.discs.size() == plain.discs.size());
  for (const Disc &disc : packed.discs) {
    CHECK(disc.radius_m == Approx(std::sqrt(0.01 / 3.14159265358979)).epsilon(1e-12));
    const auto distance_m = [&](const Disc &other) {
      return glm::length(packed.positions_m[disc.vertex] - plain.positions_m[other.vertex]);
    };
    CHECK(std::any_of(plain.discs.begin(), plain.discs.end(),
                      [&](const Disc &other) { return distance_m(other) <= largest_m; }));
  }
}

void check_same_scene(const std::string &name, double largest_m) {
  INFO(name);
  const Scene plain = load_packed("plain.gltf"), packed = load_packed(name);
  REQUIRE(packed.triangles.size() == 100);
  REQUIRE(plain.triangles.size() == 100);
  check_each_has_its_like(triangles_of(packed), triangles_of(plain), largest_m);
  check_each_has_its_like(triangles_of(plain), triangles_of(packed), largest_m);
  check_discs(packed, plain, largest_m);
  CHECK(packed.surfaces.at(packed.triangles[0].surface).double_sided);
}

} // namespace

TEST_CASE("What gltfpack writes is the plain file's scene") {
  const double step_m = 0.00027147 * 1.5; // of the quantization, and the node's scale
  const double largest_m = 0.501 * step_m * std::sqrt(3.0);
  check_same_scene("quantized.glb", largest_m);
  check_same_scene("compressed_more.glb", largest_m);
  check_same_scene("normalized.glb", largest_m);
  check_same_scene("with_fallback.gltf", largest_m);
  check_same_scene("floats.glb", 1e-6);
}
