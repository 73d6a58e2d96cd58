// Targets square to the optical axis of a lens in the world's origin that looks along -Z.
#include "host/shapes/mesh.h"
#include "host/start/kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

constexpr double light = 0.8, dark = 0.08, dim = 0.3; // reflectivities
// Half of what a wall shows that more than fills the view of a StartView, over its distance.
constexpr double half_backdrop = 0.8;

// A rectangle at -z_m, seen from the front.
void rectangle(Mesh &mesh, const glm::dvec2 &from_m, const glm::dvec2 &to_m, double z_m) {
  const glm::dvec2 centre_m = 0.5 * (from_m + to_m), half_m = 0.5 * (to_m - from_m);
  mesh.sheet(1, 1,
             [&](double u, double v) { return glm::dvec3(centre_m + half_m * glm::dvec2(u, v), -z_m); });
}

void square(Mesh &mesh, double size_m, double z_m) {
  rectangle(mesh, glm::dvec2(-0.5 * size_m), glm::dvec2(0.5 * size_m), z_m);
}

void add_backdrop(Mesh &mesh, double z_m) {
  mesh.begin("backdrop", dim);
  square(mesh, 2.0 * half_backdrop * z_m, z_m);
}

StartScene scene_of(Mesh mesh) { return {.scene = std::move(mesh).scene()}; }

// The direction in turns, and the same where it meets the square around the unit circle.
glm::dvec2 on_circle(double turns) {
  const double angle_rad = 2.0 * std::numbers::pi * turns;
  return {std::cos(angle_rad), std::sin(angle_rad)};
}
glm::dvec2 on_square(double turns) {
  const glm::dvec2 direction = on_circle(turns);
  return direction / std::max(std::abs(direction.x), std::abs(direction.y));
}

// The dark spokes of a star, or the light ones between them; each is cut into `cuts` triangles.
void add_spokes(Mesh &mesh, const StartSizes &sizes, std::uint32_t first, std::uint32_t cuts,
                double radius_m) {
  const std::uint32_t spokes = 2 * sizes.spokes, all = spokes * cuts;
  const auto at = [&](std::uint32_t i) {
    return glm::dvec3(radius_m * on_circle(static_cast<double>(i) / all), -sizes.distance_m);
  };
  for (std::uint32_t spoke = first; spoke < spokes; spoke += 2)
    for (std::uint32_t i = spoke * cuts; i < (spoke + 1) * cuts; ++i)
      mesh.triangle({0.0, 0.0, -sizes.distance_m}, at(i), at(i + 1));
}

} // namespace

StartScene ring_scene(const StartSizes &sizes) {
  Mesh mesh;
  mesh.begin("wall", 1.0);
  square(mesh, sizes.size_m, sizes.distance_m);
  return scene_of(std::move(mesh));
}

StartScene wall_scene(const StartSizes &sizes) {
  Mesh mesh;
  mesh.begin("wall", light);
  square(mesh, sizes.size_m, sizes.distance_m);
  return scene_of(std::move(mesh));
}

StartScene step_scene(const StartSizes &sizes) {
  const double half_m = 0.5 * sizes.size_m, near_m = sizes.distance_m, far_m = near_m + sizes.depth_m;
  Mesh mesh;
  mesh.begin("near", light);
  rectangle(mesh, {-half_m, -half_m}, {0.0, half_m}, near_m);
  mesh.begin("riser", light, true);
  mesh.sheet(1, 1, [&](double u, double v) {
    return glm::dvec3(0.0, half_m * v, -0.5 * (near_m + far_m) - 0.5 * sizes.depth_m * u);
  });
  mesh.begin("far", light);
  rectangle(mesh, {0.0, -half_m}, {half_m * far_m / near_m, half_m}, far_m);
  return scene_of(std::move(mesh));
}

StartScene star_scene(const StartSizes &sizes) {
  const double half_m = 0.5 * sizes.size_m, radius_m = 0.9 * half_m, z_m = sizes.distance_m;
  const std::uint32_t cuts = std::max(8u, 8 * (48 / sizes.spokes)); // of 8: cuts fall on the board's corners
  const std::uint32_t all = 2 * sizes.spokes * cuts;
  Mesh mesh;
  mesh.begin("light_spokes", light);
  add_spokes(mesh, sizes, 0, cuts, radius_m);
  mesh.begin("dark_spokes", dark);
  add_spokes(mesh, sizes, 1, cuts, radius_m);
  mesh.begin("board", light);
  for (std::uint32_t i = 0; i < all; ++i) {
    const double from = static_cast<double>(i) / all, to = static_cast<double>(i + 1) / all;
    const glm::dvec3 in_from(radius_m * on_circle(from), -z_m), in_to(radius_m * on_circle(to), -z_m);
    const glm::dvec3 out_from(half_m * on_square(from), -z_m), out_to(half_m * on_square(to), -z_m);
    mesh.triangle(in_from, out_from, out_to);
    mesh.triangle(in_from, out_to, in_to);
  }
  add_backdrop(mesh, 1.25 * z_m);
  return scene_of(std::move(mesh));
}

StartScene checkerboard_scene(const StartSizes &sizes) {
  // A border of one square on either side.
  const std::uint32_t columns = sizes.squares, rows = columns - 1;
  const double square_m = sizes.size_m / (columns + 2), z_m = sizes.distance_m;
  const auto corner = [&](double column, double row) { // from the board's middle
    return square_m * glm::dvec2(column - 0.5 * columns, row - 0.5 * rows);
  };
  Mesh mesh;
  for (const std::uint32_t is_dark : {0u, 1u}) {
    mesh.begin(is_dark ? "dark_squares" : "light_squares", is_dark ? dark : light);
    for (std::uint32_t row = 0; row < rows; ++row)
      for (std::uint32_t column = 0; column < columns; ++column)
        if ((row + column) % 2 != is_dark)
          rectangle(mesh, corner(column, row), corner(column + 1, row + 1), z_m);
  }
  mesh.begin("border", light);
  rectangle(mesh, corner(-1, -1), corner(0, rows + 1), z_m);
  rectangle(mesh, corner(columns, -1), corner(columns + 1, rows + 1), z_m);
  rectangle(mesh, corner(0, -1), corner(columns, 0), z_m);
  rectangle(mesh, corner(0, rows), corner(columns, rows + 1), z_m);
  add_backdrop(mesh, 1.25 * z_m);
  return scene_of(std::move(mesh));
}

StartScene ball_scene(const StartSizes &sizes) {
  constexpr std::uint32_t cells = 48; // within 1.3e-4 radii of a sphere
  Mesh mesh;
  mesh.begin("ball", light);
  mesh.sphere({0.0, 0.0, -sizes.distance_m}, 0.5 * sizes.size_m, cells);
  add_backdrop(mesh, 1.25 * sizes.distance_m + 0.5 * sizes.size_m);
  return scene_of(std::move(mesh));
}

StartScene corner_scene(const StartSizes &sizes) {
  const double along_m = sizes.size_m / std::numbers::sqrt2, half_m = 0.5 * sizes.size_m;
  Mesh mesh;
  for (const double side : {-1.0, 1.0}) {
    mesh.begin(side < 0 ? "left_wall" : "right_wall", light);
    // u grows to the right: towards the edge on the left wall, away from it on the right one.
    mesh.sheet(1, 1, [&](double u, double v) {
      const double out_m = along_m * 0.5 * (1.0 + side * u);
      return glm::dvec3(side * out_m, half_m * v, out_m - sizes.distance_m);
    });
  }
  return scene_of(std::move(mesh));
}

} // namespace pmdsim
