// Scenes that are awkward for whatever traces them.
#include "host/bench/real/kinds.h"
#include "host/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

const glm::dvec3 lower_m(-1.0, -1.0, -4.0), upper_m(1.0, 1.0, -1.2);

} // namespace

Scene soup(std::uint32_t triangles) {
  Random random(6);
  Mesh mesh;
  mesh.wall(-4.5);
  mesh.begin("soup", 0.6, true);
  const double size_m = 1.5 / std::cbrt(triangles);
  while (mesh.triangles() < triangles) {
    const glm::dvec3 centre_m = random.in_box(lower_m, upper_m);
    const glm::dvec3 a = random.unit_vector(), b = random.unit_vector(), c = random.unit_vector();
    mesh.triangle(centre_m + size_m * a, centre_m + size_m * b, centre_m + size_m * c);
  }
  return std::move(mesh).scene();
}

Scene fans(std::uint32_t triangles) {
  constexpr std::uint32_t wings = 16;
  Random random(7);
  Mesh mesh;
  mesh.wall(-4.5);
  mesh.begin("fans", 0.6, true);
  const double size_m = 3.0 / std::cbrt(triangles);
  while (mesh.triangles() < triangles) {
    const glm::dvec3 centre_m = random.in_box(lower_m, upper_m);
    const glm::dmat3 frame = frame_along(random.unit_vector());
    const std::uint32_t from = mesh.vertex(centre_m - size_m * frame[2]);
    const std::uint32_t to = mesh.vertex(centre_m + size_m * frame[2]);
    for (std::uint32_t i = 0; i < wings; ++i) {
      const double angle_rad = 2 * std::numbers::pi * i / wings;
      mesh.triangle(
          from, to,
          mesh.vertex(centre_m + size_m * (std::cos(angle_rad) * frame[0] + std::sin(angle_rad) * frame[1])));
    }
  }
  return std::move(mesh).scene();
}

// Balls that intersect in pairs, boxes that stand on each other and on the ground, balls on boxes.
Scene touching(std::uint32_t triangles) {
  constexpr std::uint32_t piles = 8;
  Mesh mesh;
  mesh.wall(-4);
  mesh.ground(-0.75);
  mesh.begin("piles", 0.6);
  const auto cells =
      static_cast<std::uint32_t>(std::max(2L, std::lround(std::sqrt(triangles / (12.0 * 3 * piles)))));
  for (std::uint32_t i = 0; i < piles; ++i) {
    const glm::dvec3 foot_m(centred(i, piles - 1), -0.75, -2.0 - 0.25 * (i % 3));
    mesh.box(foot_m + glm::dvec3(0, 0.125, 0), glm::dvec3(0.1, 0.125, 0.1));
    mesh.box(foot_m + glm::dvec3(0.0625, 0.375, 0), glm::dvec3(0.1, 0.125, 0.1));
    mesh.sphere(foot_m + glm::dvec3(0, 0.625, 0), 0.125, cells);
    mesh.sphere(foot_m + glm::dvec3(0.1, 0.7, 0.03), 0.125, cells);
    mesh.sphere(foot_m + glm::dvec3(0.125, 0.125, 0.2), 0.125, cells);
  }
  return std::move(mesh).scene();
}

// Rods beside, inside and among the ring's diodes.
Scene piercing(std::uint32_t triangles) {
  Random random(8);
  Mesh mesh;
  mesh.wall(-2.5);
  mesh.begin("rods", 0.5);
  constexpr std::uint32_t rods = 24, facets = 10;
  const std::uint32_t rows = std::max(1u, triangles / (2 * facets * rods) - 1);
  for (std::uint32_t i = 0; i < rods; ++i) {
    const double angle_rad = 2 * std::numbers::pi * (i + random.uniform(0, 0.5)) / rods;
    const double radius_m = random.uniform(0.05, 0.3), reach = random.uniform(1.2, 3.0);
    const glm::dvec3 out(std::cos(angle_rad), std::sin(angle_rad), 0);
    mesh.rod(radius_m * out + glm::dvec3(0, 0, 0.2),
             reach * radius_m * out - glm::dvec3(0, 0, random.uniform(0.2, 1.5)), 0.004, 0.003, facets, rows);
  }
  return std::move(mesh).scene();
}

Scene needles(std::uint32_t triangles) {
  Random random(9);
  Mesh mesh;
  mesh.wall(-4.5);
  mesh.begin("needles", 0.6, true);
  while (mesh.triangles() < triangles) {
    const glm::dvec3 centre_m = random.in_box(lower_m + glm::dvec3(0, 0, 0.5), upper_m - glm::dvec3(0, 0, 1));
    const glm::dmat3 frame = frame_along(random.unit_vector());
    mesh.triangle(centre_m - frame[2] - 3e-3 * frame[0], centre_m - frame[2] + 3e-3 * frame[0],
                  centre_m + frame[2]);
  }
  return std::move(mesh).scene();
}

} // namespace pmdsim
