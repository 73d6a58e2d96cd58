// Buildings, furniture and people.
#include "host/bench/real/kinds.h"
#include "host/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

// The end of a part that begins at `from_m` and turns by up to `spread` from `direction`.
glm::dvec3 joint(Random &random, const glm::dvec3 &from_m, double length_m, const glm::dvec3 &direction,
                 double spread) {
  return from_m + length_m * glm::normalize(direction + spread * random.unit_vector());
}

// A figure of ten capsules and a ball, `height_m` tall, with its feet near `foot_m`.
void add_figure(Mesh &mesh, Random &random, const glm::dvec3 &foot_m, double height_m, std::uint32_t facets,
                std::uint32_t rows) {
  const double turn_rad = random.uniform(0, 2 * std::numbers::pi);
  const glm::dvec3 right(std::cos(turn_rad), 0, std::sin(turn_rad)), up(0, 1, 0), down = -up;
  const glm::dvec3 hip_m = foot_m + 0.5 * height_m * up;
  const glm::dvec3 neck_m = joint(random, hip_m, 0.32 * height_m, up, 0.2);
  mesh.capsule(hip_m, neck_m, 0.085 * height_m, facets, rows);
  mesh.sphere(joint(random, neck_m, 0.13 * height_m, up, 0.3), 0.075 * height_m,
              std::max(2u, static_cast<std::uint32_t>(std::sqrt(facets * rows / 6.0))));
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 shoulder_m = neck_m + 0.12 * side * height_m * right;
    const glm::dvec3 elbow_m = joint(random, shoulder_m, 0.17 * height_m, down + 0.4 * side * right, 0.8);
    const glm::dvec3 thigh_m = hip_m + 0.06 * side * height_m * right;
    const glm::dvec3 knee_m = joint(random, thigh_m, 0.24 * height_m, down, 0.4);
    mesh.capsule(neck_m, shoulder_m, 0.04 * height_m, facets, rows);
    mesh.capsule(shoulder_m, elbow_m, 0.035 * height_m, facets, rows);
    mesh.capsule(elbow_m, joint(random, elbow_m, 0.16 * height_m, elbow_m - shoulder_m, 0.2), 0.03 * height_m,
                 facets, rows);
    mesh.capsule(thigh_m, knee_m, 0.05 * height_m, facets, rows);
    mesh.capsule(knee_m, joint(random, knee_m, 0.24 * height_m, down, 0.3), 0.04 * height_m, facets, rows);
  }
}

// Legs and a top.
void add_table(Mesh &mesh, const glm::dvec3 &floor_m, const glm::dvec3 &size_m) {
  const glm::dvec3 top_half(0.5 * size_m.x, 0.02, 0.5 * size_m.z);
  mesh.box(floor_m + glm::dvec3(0, size_m.y, 0), top_half);
  for (const double x : {-0.45, 0.45})
    for (const double z : {-0.45, 0.45})
      mesh.box(floor_m + glm::dvec3(x * size_m.x, 0.5 * size_m.y - 0.01, z * size_m.z),
               glm::dvec3(0.02, 0.5 * size_m.y - 0.01, 0.02));
}

// Boards that stand against the wall behind, and books on them.
void add_shelf(Mesh &mesh, Random &random, std::uint32_t books) {
  constexpr std::uint32_t boards = 6;
  for (std::uint32_t i = 0; i < boards; ++i)
    mesh.box({-0.6, -0.8 + 0.36 * i, -3.75}, glm::dvec3(1.05, 0.012, 0.16));
  const std::uint32_t on_each = (books + boards - 1) / boards;
  for (std::uint32_t i = 0; i < books; ++i) {
    const std::uint32_t board = i / on_each;
    const double pitch_m = 2.0 / on_each, x_m = -1.6 + pitch_m * (i % on_each + 0.5);
    const glm::dvec3 half_m(0.42 * pitch_m, random.uniform(0.08, 0.15), random.uniform(0.07, 0.13));
    mesh.box({x_m, -0.8 + 0.36 * board + 0.013 + half_m.y, -3.8}, half_m);
  }
}

} // namespace

Scene colonnade(std::uint32_t triangles) {
  constexpr std::uint32_t columns = 12;
  Mesh mesh;
  mesh.wall(-5.5);
  mesh.ground(-0.8);
  const auto facets = static_cast<std::uint32_t>(std::sqrt(triangles / (2.0 * columns) / 1.5));
  const std::uint32_t rows = std::max(1u, triangles / (2 * columns * facets));
  mesh.begin("columns", 0.7);
  for (std::uint32_t i = 0; i < columns; ++i) {
    const std::uint32_t pair = i / 2;
    const glm::dvec3 foot_m(i % 2 == 0 ? -0.55 : 0.6, -0.8, -1.3 - 0.65 * pair);
    mesh.box(foot_m + glm::dvec3(0, 0.03, 0), glm::dvec3(0.16, 0.03, 0.16));
    mesh.box(foot_m + glm::dvec3(0, 1.67, 0), glm::dvec3(0.17, 0.03, 0.17));
    mesh.sheet(facets, rows, [&](double u, double v) {
      const double angle_rad = std::numbers::pi * u;
      const double radius_m = (0.12 - 0.015 * v) * (1 + 0.06 * std::abs(std::cos(8 * angle_rad)));
      return foot_m +
             glm::dvec3(radius_m * std::sin(angle_rad), 0.85 + 0.79 * v, radius_m * std::cos(angle_rad));
    });
  }
  return std::move(mesh).scene();
}

Scene crowd(std::uint32_t triangles) {
  Random random(3);
  Mesh mesh;
  mesh.wall(-5.5);
  mesh.ground(-0.9);
  mesh.begin("figures", 0.5);
  const auto figures = static_cast<std::uint32_t>(std::max(4.0, std::sqrt(triangles / 100.0)));
  const double cells = triangles / (2.0 * 11 * figures); // of a capsule, three of whose rows are 4 facets
  const auto rows = std::max(3u, 3 * static_cast<std::uint32_t>(std::lround(std::sqrt(0.75 * cells) / 3)));
  const auto facets = std::max(3u, static_cast<std::uint32_t>(std::lround(cells / (rows - 1))));
  for (std::uint32_t i = 0; i < figures; ++i) {
    const double z_m = random.uniform(1.7, 5.0);
    add_figure(mesh, random, {(0.5 * z_m) * random.uniform(-1, 1), -0.9, -z_m}, random.uniform(0.9, 1.4),
               facets, rows);
  }
  return std::move(mesh).scene();
}

Scene furnished(std::uint32_t triangles) {
  Random random(4);
  Mesh mesh;
  mesh.wall(-4);
  mesh.ground(-0.9);
  mesh.begin("furniture", 0.4);
  add_table(mesh, {0.5, -0.9, -2.6}, {1.1, 0.6, 0.7});
  for (const double x_m : {0.2, 0.8, 1.2})
    add_table(mesh, {x_m, -0.9, -1.9}, {0.3, 0.3, 0.3});
  mesh.box({-1.0, -0.65, -2.4}, glm::dvec3(0.45, 0.25, 0.3));
  add_shelf(mesh, random, triangles / 48);
  mesh.begin("balls", 0.7);
  constexpr std::uint32_t balls = 14;
  const double left = std::max(0.0, static_cast<double>(triangles) - static_cast<double>(mesh.triangles()));
  const auto cells = static_cast<std::uint32_t>(std::max(2L, std::lround(std::sqrt(left / (12.0 * balls)))));
  for (std::uint32_t i = 0; i < balls; ++i) {
    const double radius_m = random.uniform(0.05, 0.16);
    const glm::dvec3 on_floor = random.in_box({-1.2, -0.9, -3.2}, {1.0, -0.9, -1.9});
    const glm::dvec3 on_table = random.in_box({0.05, -0.28, -2.9}, {0.95, -0.28, -2.3});
    mesh.sphere((i % 2 == 0 ? on_floor : on_table) + glm::dvec3(0, radius_m, 0), radius_m, cells);
  }
  return std::move(mesh).scene();
}

} // namespace pmdsim
