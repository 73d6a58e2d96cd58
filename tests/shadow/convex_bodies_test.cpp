// Which meshes are closed convex bodies, and which only nearly are.

#include "engine/shadow/occluders.h"

#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using Faces = std::vector<std::array<std::uint32_t, 3>>;

struct Mesh {
  std::vector<glm::dvec3> corners_m;
  Faces faces;
};

Mesh box(const glm::dvec3 &low_m = glm::dvec3(-1.0), const glm::dvec3 &high_m = glm::dvec3(1.0)) {
  Mesh mesh{{},
            {{0, 2, 1},
             {1, 2, 3},
             {4, 5, 6},
             {5, 7, 6},
             {0, 1, 4},
             {1, 5, 4},
             {2, 6, 3},
             {3, 6, 7},
             {0, 4, 2},
             {2, 4, 6},
             {1, 3, 5},
             {3, 7, 5}}};
  for (unsigned k = 0; k < 8; ++k)
    mesh.corners_m.push_back(glm::mix(low_m, high_m, glm::bvec3(k & 1, k & 2, k & 4)));
  return mesh;
}

// A box whose sides are cut into `cuts` x `cuts` squares.
Mesh fine_box(std::uint32_t cuts) {
  Mesh mesh;
  for (glm::length_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.corners_m.size());
      for (std::uint32_t v = 0; v <= cuts; ++v)
        for (std::uint32_t u = 0; u <= cuts; ++u) {
          glm::dvec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = (2.0 * u - cuts) / cuts; // as exactly on the side beyond the edge
          p[(axis + 2) % 3] = side * (2.0 * v - cuts) / cuts;
          mesh.corners_m.push_back(p);
        }
      for (std::uint32_t v = 0; v < cuts; ++v)
        for (std::uint32_t u = 0; u < cuts; ++u) {
          const std::uint32_t at = first + v * (cuts + 1) + u;
          mesh.faces.push_back({at, at + 1, at + cuts + 2});
          mesh.faces.push_back({at, at + cuts + 2, at + cuts + 1});
        }
    }
  return mesh;
}

// Cut along `rings` circles of latitude: its corners lie on the ball, its quadrilaterals in planes.
Mesh ball(std::uint32_t rings) {
  const std::uint32_t sectors = 2 * rings, last = rings * sectors;
  Mesh mesh;
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t sector = 0; sector < sectors; ++sector) {
      const double down = std::numbers::pi * (ring + 1) / (rings + 1),
                   around = 2.0 * std::numbers::pi * sector / sectors;
      mesh.corners_m.emplace_back(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around),
                                  std::cos(down));
      const std::uint32_t here = ring * sectors + sector, aside = ring * sectors + (sector + 1) % sectors;
      if (ring == 0)
        mesh.faces.push_back({last, here, aside});
      if (ring + 1 < rings) {
        mesh.faces.push_back({here, here + sectors, aside + sectors});
        mesh.faces.push_back({here, aside + sectors, aside});
      } else {
        mesh.faces.push_back({here, last + 1, aside});
      }
    }
  mesh.corners_m.emplace_back(0, 0, 1);
  mesh.corners_m.emplace_back(0, 0, -1);
  return mesh;
}

Mesh torus() {
  constexpr std::uint32_t sides = 24;
  Mesh mesh;
  for (std::uint32_t i = 0; i < sides; ++i)
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double around = 2.0 * std::numbers::pi * i / sides, tube = 2.0 * std::numbers::pi * k / sides;
      const double radius = 1.0 + 0.3 * std::cos(tube);
      mesh.corners_m.emplace_back(radius * std::cos(around), radius * std::sin(around), 0.3 * std::sin(tube));
      const std::uint32_t next_i = (i + 1) % sides * sides, next_k = (k + 1) % sides;
      mesh.faces.push_back({i * sides + k, next_i + k, next_i + next_k});
      mesh.faces.push_back({i * sides + k, next_i + next_k, i * sides + next_k});
    }
  return mesh;
}

// Regular, with 20 triangles that pass through each other: each edge is convex, and it is a ball as to how
// its vertices, edges and triangles hang together.
Mesh great_icosahedron() {
  constexpr double g = std::numbers::phi;
  Mesh mesh;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g})
      for (const glm::dvec3 &p : {glm::dvec3(0, s, t), glm::dvec3(s, t, 0), glm::dvec3(t, 0, s)})
        mesh.corners_m.push_back(p);
  const auto is_edge = [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(glm::distance(mesh.corners_m[a], mesh.corners_m[b]) - 2.0 * g) < 1e-9;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c)
        if (is_edge(a, b) && is_edge(b, c) && is_edge(c, a)) {
          const auto &p = mesh.corners_m;
          const bool front = glm::dot(glm::cross(p[b] - p[a], p[c] - p[a]), p[a]) > 0.0;
          mesh.faces.push_back(front ? std::array{a, b, c} : std::array{a, c, b});
        }
  return mesh;
}

Mesh inside_out(Mesh mesh) {
  for (auto &face : mesh.faces)
    std::swap(face[1], face[2]);
  return mesh;
}

// Each triangle with vertices of its own, as along a file's seams.
Mesh loose(const Mesh &mesh) {
  Mesh result;
  for (const auto &face : mesh.faces) {
    const auto first = static_cast<std::uint32_t>(result.corners_m.size());
    for (const std::uint32_t corner : face)
      result.corners_m.push_back(mesh.corners_m[corner]);
    result.faces.push_back({first, first + 1, first + 2});
  }
  return result;
}

void add(SceneBuilder &builder, const Mesh &mesh, const Surface &surface = {}) {
  builder.add_mesh(mesh.corners_m, mesh.faces, surface);
}

// All its triangles are one body, or none of any.
bool is_body(const Mesh &mesh, const Surface &surface = {}) {
  Random random(71);
  SceneBuilder builder(random.pose(3.0));
  add(builder, mesh, surface);
  const auto bodies = convex_bodies(builder.scene());
  REQUIRE(bodies.size() == mesh.faces.size());
  REQUIRE(std::set(bodies.begin(), bodies.end()).size() == 1);
  return bodies.front() != no_id;
}

} // namespace

TEST_CASE("boxes and balls are convex bodies, however finely they are cut") {
  CHECK(is_body(box()));
  CHECK(is_body(box({0, 0, 0}, {10, 10, 0.01})));
  CHECK(is_body(loose(box())));
  CHECK(is_body(fine_box(10)));
  CHECK(is_body(ball(4)));
  CHECK(is_body(ball(30)));
  CHECK(is_body(loose(ball(10))));
}

TEST_CASE("what is open, bent inwards, inside out or has a hole through it is no convex body") {
  Mesh open = box();
  open.faces.pop_back();
  CHECK_FALSE(is_body(open));
  CHECK_FALSE(is_body(inside_out(box())));
  Mesh one_turned = box();
  std::swap(one_turned.faces[0][1], one_turned.faces[0][2]);
  CHECK_FALSE(is_body(one_turned));
  Mesh dented = ball(10);
  dented.corners_m[100] *= 0.9;
  CHECK_FALSE(is_body(dented));
  CHECK_FALSE(is_body(torus()));
  Mesh twice = box();
  for (const auto &face : box().faces)
    twice.faces.push_back(face);
  CHECK_FALSE(is_body(twice));
}

TEST_CASE("what may have holes is no convex body, what is painted otherwise may be") {
  Surface surface;
  surface.paint = Paint{};
  CHECK(is_body(box(), surface));
  surface.paint->alpha_cutoff = 0.5;
  CHECK_FALSE(is_body(box(), surface));
}

TEST_CASE("bodies apart are different bodies, such as share a vertex none") {
  SceneBuilder builder;
  add(builder, box({0, 0, 0}, {1, 1, 1}));
  builder.add_wall({3.0});
  add(builder, box({2, 0, 0}, {3, 1, 1}));
  const auto bodies = convex_bodies(builder.scene());
  REQUIRE(bodies.size() == 26);
  CHECK(std::set(bodies.begin(), bodies.begin() + 12).size() == 1);
  CHECK(std::set(bodies.begin() + 14, bodies.end()).size() == 1);
  CHECK(bodies[0] != no_id);
  CHECK(bodies[12] == no_id);
  CHECK(bodies[14] != no_id);
  CHECK(bodies[0] != bodies[14]);
  SceneBuilder touching;
  add(touching, box({0, 0, 0}, {1, 1, 1}));
  add(touching, box({1, 1, 1}, {2, 2, 2}));
  const auto of_touching = convex_bodies(touching.scene());
  CHECK(of_touching == std::vector<std::uint32_t>(24, no_id));
}

TEST_CASE("a body that passes through itself is not convex, though each of its edges is") {
  REQUIRE(great_icosahedron().faces.size() == 20);
  CHECK_FALSE(is_body(great_icosahedron()));
}

TEST_CASE("a shallow dish is not convex, however finely it is cut") {
  for (const std::uint32_t cuts : {20u, 100u}) {
    Mesh mesh = fine_box(cuts);
    for (glm::dvec3 &p : mesh.corners_m)
      if (p.x == 1.0) // 0.4 mm deep, of two metres
        p.x -= 0.0004 * (1.0 - p.y * p.y) * (1.0 - p.z * p.z);
    CHECK_FALSE(is_body(mesh));
  }
}
