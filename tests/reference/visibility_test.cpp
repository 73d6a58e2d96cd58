// The lens sees the nearest shape, culled faces do not exist, and no ray slips between neighbours.

#include "engine/reference/reference.h"
#include "engine/reference/view/ray_caster.h"
#include "tests/reference/shadow_fixture.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using reference::CameraTriangle;
using reference::Hit;
using reference::RayCaster;

namespace {

std::vector<CameraTriangle> triangles_of(const Scene &scene) {
  return reference::triangles_in_camera(scene, Sensor{});
}

// T. Moeller, B. Trumbore, "Fast, minimum storage ray/triangle intersection" (1997): another formula than the
// caster's.
std::optional<double> moeller_trumbore(const glm::dvec3 &direction, const CameraTriangle &triangle) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 p = glm::cross(direction, c - a);
  const double determinant = glm::dot(b - a, p);
  if (determinant == 0 || (determinant < 0 && !triangle.double_sided))
    return std::nullopt;
  const double u = glm::dot(-a, p) / determinant;
  const glm::dvec3 q = glm::cross(-a, b - a);
  const double v = glm::dot(direction, q) / determinant;
  const double t = glm::dot(c - a, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? std::optional(t) : std::nullopt;
}

std::uint32_t nearest_of_all(const glm::dvec3 &direction, const std::vector<CameraTriangle> &triangles) {
  std::uint32_t nearest = no_id;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::uint32_t id = 0; id < triangles.size(); ++id)
    if (const auto range_m = moeller_trumbore(direction, triangles[id]); range_m && *range_m < nearest_m) {
      nearest = id;
      nearest_m = *range_m;
    }
  return nearest;
}

void check_against_all(const std::vector<CameraTriangle> &triangles, Random &random, int rays) {
  const RayCaster caster(triangles);
  int hits = 0, disagreements = 0;
  for (int i = 0; i < rays; ++i) {
    const glm::dvec3 direction = glm::normalize(random.in_box({-0.7, -0.7, 1}, {0.7, 0.7, 1}));
    const auto hit = caster.nearest(direction);
    hits += hit.has_value();
    disagreements += (hit ? hit->id : no_id) != nearest_of_all(direction, triangles);
  }
  CHECK(hits > rays / 20);
  CHECK(disagreements == 0);
}

// A bumpy sheet of 2 n^2 triangles that share their vertices, with a random depth at each.
Scene bumpy_sheet(Random &random, std::uint32_t n) {
  std::vector<glm::dvec3> corners_m;
  for (std::uint32_t row = 0; row <= n; ++row)
    for (std::uint32_t column = 0; column <= n; ++column) {
      const double z_m = random.uniform(1.9, 2.1);
      corners_m.emplace_back((column - 0.5 * n) / n * z_m, (row - 0.5 * n) / n * z_m, z_m);
    }
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t row = 0; row < n; ++row)
    for (std::uint32_t column = 0; column < n; ++column) {
      const std::uint32_t corner = row * (n + 1) + column;
      faces.push_back({corner, corner + n + 1, corner + n + 2});
      faces.push_back({corner, corner + n + 2, corner + 1});
    }
  SceneBuilder builder;
  builder.add_mesh(corners_m, faces);
  return builder.scene();
}

// A closed, bumpy ball about the lens, of 4 n (n - 1) triangles that share their vertices, with a random
// radius at each; its poles on the optical axis.
Scene bumpy_ball(Random &random, std::uint32_t n) {
  const std::uint32_t columns = 2 * n, south = (n - 1) * columns, north = south + 1;
  std::vector<glm::dvec3> corners_m;
  for (std::uint32_t ring = 1; ring < n; ++ring)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double polar_rad = std::numbers::pi * ring / n, turn_rad = std::numbers::pi * column / n;
      corners_m.push_back(random.uniform(1.9, 2.1) * glm::dvec3(std::sin(polar_rad) * std::cos(turn_rad),
                                                                std::sin(polar_rad) * std::sin(turn_rad),
                                                                std::cos(polar_rad)));
    }
  corners_m.insert(corners_m.end(), {{0, 0, -2}, {0, 0, 2}});

  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t column = 0; column < columns; ++column) {
    const std::uint32_t next = (column + 1) % columns, last_ring = south - columns;
    faces.push_back({north, column, next});
    faces.push_back({south, last_ring + column, last_ring + next});
    for (std::uint32_t ring = 0; ring < last_ring; ring += columns) {
      faces.push_back({ring + column, ring + next, ring + columns + next});
      faces.push_back({ring + column, ring + columns + next, ring + columns + column});
    }
  }
  SceneBuilder builder;
  builder.add_mesh(corners_m, faces, {1.0, true});
  return builder.scene();
}

// Counter-clockwise seen from outside, about the origin.
const std::vector<glm::dvec3> tetrahedron_corners{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
const std::vector<std::array<std::uint32_t, 3>> tetrahedron_faces{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};

// Where a ray enters and leaves a closed convex body, whichever way its faces look.
std::optional<std::pair<double, double>> way_through(const glm::dvec3 &direction,
                                                     std::vector<CameraTriangle> faces) {
  std::vector<double> crossings_m;
  for (CameraTriangle &face : faces) {
    face.double_sided = true;
    if (const auto range_m = moeller_trumbore(direction, face))
      crossings_m.push_back(*range_m);
  }
  if (crossings_m.empty())
    return std::nullopt;
  const auto [enters, leaves] = std::minmax_element(crossings_m.begin(), crossings_m.end());
  return std::pair(*enters, *leaves);
}

} // namespace

TEST_CASE("the nearest triangle is the one that a search over all of them finds") {
  const std::uint32_t seed = GENERATE(1u, 2u, 3u, 4u);
  Random random(seed);
  check_against_all(triangles_of(random_triangles(random, 300, node_from_camera())), random, 20000);
}

TEST_CASE("rays to all sides find the triangle that a search over all of them finds") {
  Random random(12);
  SceneBuilder builder;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 centre_m = random.uniform(1, 3) * random.unit_vector();
    builder.add_triangle(centre_m + 0.5 * random.unit_vector(), centre_m + 0.5 * random.unit_vector(),
                         centre_m + 0.5 * random.unit_vector(), {1.0, random.flip()});
  }
  const auto triangles = triangles_of(builder.scene());
  const RayCaster caster(triangles);
  int hits = 0, disagreements = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 direction = random.unit_vector();
    const auto hit = caster.nearest(direction);
    hits += hit.has_value();
    disagreements += (hit ? hit->id : no_id) != nearest_of_all(direction, triangles);
  }
  CHECK(hits > 5000);
  CHECK(disagreements == 0);
}

TEST_CASE("close stacks of triangles are told apart in double precision") {
  Random random(5);
  SceneBuilder builder;
  // Far closer than float can tell apart at 2 m, in an order that is not that of the distances.
  for (const int layer : {3, 0, 4, 1, 2})
    builder.add_wall({2 + layer * 1e-12});
  const RayCaster caster(triangles_of(builder.scene()));
  for (int i = 0; i < 1000; ++i) {
    const auto hit = caster.nearest(glm::normalize(random.in_box({-0.7, -0.7, 1}, {0.7, 0.7, 1})));
    REQUIRE(hit);
    REQUIRE(hit->id / 2 == 1);
  }
}

TEST_CASE("of two coincident triangles the lower id is seen") {
  SceneBuilder builder;
  for (int i = 0; i < 3; ++i)
    builder.add_triangle({-5, -5, 2}, {-5, 5, 2}, {5, 5, 2});
  CHECK(RayCaster(triangles_of(builder.scene())).nearest(glm::normalize(glm::dvec3(-0.2, 0.1, 1)))->id == 0);
}

TEST_CASE("rays through shared edges and vertices always hit") {
  Random random(6);
  const auto triangles = triangles_of(bumpy_sheet(random, 40));
  const RayCaster caster(triangles);
  int misses = 0;
  for (const CameraTriangle &triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &from = triangle.corners_m[i], &to = triangle.corners_m[(i + 1) % 3];
      const glm::dvec3 on_edge = glm::mix(from, to, random.uniform(0, 1));
      const bool on_border = std::max(std::abs(on_edge.x), std::abs(on_edge.y)) > 0.4999 * on_edge.z;
      misses += !on_border && !caster.nearest(glm::normalize(on_edge));
      misses += std::max(std::abs(from.x), std::abs(from.y)) < 0.4999 * from.z &&
                !caster.nearest(glm::normalize(from));
    }
  CHECK(misses == 0);
}

TEST_CASE("no ray to any side leaves a closed body through an edge or a vertex") {
  Random random(13);
  const auto triangles = triangles_of(bumpy_ball(random, 24));
  const RayCaster caster(triangles);
  int misses = 0;
  for (const CameraTriangle &triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 &from = triangle.corners_m[i], &to = triangle.corners_m[(i + 1) % 3];
      misses += !caster.nearest(glm::normalize(from));
      for (int along_edge = 0; along_edge < 5; ++along_edge)
        misses += !caster.nearest(glm::normalize(glm::mix(from, to, random.uniform(0, 1))));
    }
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 direction(0);
      direction[axis] = sign;
      misses += !caster.nearest(direction);
    }
  CHECK(misses == 0);
}

TEST_CASE("rays a nanometre beside an edge hit the triangle on that side") {
  Random random(9);
  const auto triangles = triangles_of(bumpy_sheet(random, 20));
  const RayCaster caster(triangles);
  int wrong = 0;
  for (std::uint32_t id = 0; id < triangles.size(); ++id)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &corners_m = triangles[id].corners_m;
      const glm::dvec3 on_edge = glm::mix(corners_m[i], corners_m[(i + 1) % 3], random.uniform(0.1, 0.9));
      const glm::dvec3 beside_edge = glm::mix(on_edge, corners_m[(i + 2) % 3], 1e-8);
      const auto hit = caster.nearest(glm::normalize(beside_edge));
      wrong += !hit || hit->id != id;
    }
  CHECK(wrong == 0);
}

TEST_CASE("pixels whose rays run along a wall's diagonal are covered") {
  SceneBuilder builder;
  builder.add_wall({2, {}, {-1, -1}, {1, 1}});
  const Sensor sensor = wide_sensor({101, 101}, 0.9);
  const auto frame = reference::simulate(
      builder.scene(), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  CHECK(*std::min_element(frame.coverage.begin(), frame.coverage.end()) == 1);
}

TEST_CASE("a culled back face is invisible and hides nothing") {
  SceneBuilder builder;
  const bool double_sided = GENERATE(false, true);
  builder.add_triangle({-5, -5, 1}, {5, 5, 1}, {-5, 5, 1},
                       {1.0, double_sided}); // clockwise as the lens sees it
  builder.add_triangle({-9, -9, 2}, {-9, 9, 2}, {9, 9, 2});
  const auto hit = RayCaster(triangles_of(builder.scene())).nearest(glm::normalize(glm::dvec3(-0.2, 0.1, 1)));
  REQUIRE(hit);
  CHECK(hit->id == (double_sided ? 0 : 1));
}

TEST_CASE("what lies behind the lens is not seen, however near") {
  SceneBuilder builder;
  builder.add_triangle({-5, -5, -3}, {-5, 5, -3}, {5, 0, 1}, {1.0, true}); // reaches in front of the lens
  builder.add_wall({2});
  builder.add_triangle({-1e-3, -1e-3, 1e-4}, {-1e-3, 1e-3, 1e-4}, {1e-3, 1e-3, 1e-4});
  const RayCaster caster(triangles_of(builder.scene()));
  CHECK(caster.nearest(glm::normalize(glm::dvec3(0.2, -0.1, 1)))->id == 2);
  CHECK(caster.nearest(glm::normalize(glm::dvec3(-0.2, 0.1, 1)))->id == 3);
}

TEST_CASE("a closed body shows the lens its near faces, turned inside out its far ones") {
  Random random(8);
  const bool inside_out = GENERATE(false, true);
  std::vector<glm::dvec3> corners_m;
  for (const glm::dvec3 &corner : tetrahedron_corners)
    corners_m.push_back(glm::dvec3(0.1, -0.05, 2) + 0.4 * (inside_out ? -corner : corner));
  SceneBuilder builder;
  builder.add_mesh(corners_m, tetrahedron_faces);
  const auto faces = triangles_of(builder.scene());

  const RayCaster caster(faces);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 direction = glm::normalize(random.in_box({-0.4, -0.4, 1}, {0.4, 0.4, 1}));
    const auto way = way_through(direction, faces);
    const auto hit = caster.nearest(direction);
    REQUIRE(hit.has_value() == way.has_value());
    if (!hit)
      continue;
    ++hits;
    REQUIRE(hit->range_m == Approx(inside_out ? way->second : way->first).epsilon(1e-12));
  }
  CHECK(hits > 500);
}

TEST_CASE("no triangles, no hits") { CHECK_FALSE(RayCaster({}).nearest({0, 0, 1})); }
