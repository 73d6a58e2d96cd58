// Scenes of many thin parts.
#include "host/bench/real/kinds.h"
#include "host/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace pmdsim {
namespace {

// On a level ground, where half the view has the tangent 0.5.
glm::dvec3 place_on_ground(Random &random, double y_m, double near_m, double far_m) {
  const double z_m = random.uniform(near_m, far_m);
  return {(0.5 * z_m + 0.3) * random.uniform(-1, 1), y_m, -z_m};
}

void add_blade(Mesh &mesh, Random &random, const glm::dvec3 &foot_m) {
  const double turn_rad = random.uniform(0, 2 * std::numbers::pi), height_m = random.uniform(0.12, 0.45);
  const double half_m = random.uniform(2e-3, 5e-3);
  const glm::dvec3 across(std::cos(turn_rad), 0, std::sin(turn_rad));
  const glm::dvec3 lean = random.in_box({-0.3, 0, -0.3}, {0.3, 0, 0.3});
  mesh.sheet(1, 2, [&](double u, double v) {
    const double up = 0.5 + 0.5 * v; // bent and narrower upwards
    return foot_m + height_m * (glm::dvec3(0, up, 0) + up * up * lean) + (1 - 0.8 * up) * u * half_m * across;
  });
}

// A tree of 24 triangles for the trunk and 80 for each of three cones.
void add_tree(Mesh &mesh, const glm::dvec3 &foot_m, double height_m) {
  const auto at = [&](double part) { return foot_m + glm::dvec3(0, part * height_m, 0); };
  mesh.rod(at(0), at(0.35), 0.035 * height_m, 0.025 * height_m, 6);
  for (int i = 0; i < 3; ++i)
    mesh.rod(at(0.25 + 0.22 * i), at(0.6 + 0.2 * i), (0.24 - 0.06 * i) * height_m, 0.0, 40);
}

void add_leaf(Mesh &mesh, Random &random, const glm::dvec3 &foot_m, double height_m) {
  const glm::dmat3 frame = frame_along(random.unit_vector());
  const double up = random.uniform(0.3, 1.0), reach_m = (1.1 - up) * 0.5 * height_m;
  const glm::dvec3 at_m = foot_m + glm::dvec3(0, up * height_m, 0) + reach_m * random.unit_vector();
  const double size_m = random.uniform(0.006, 0.02);
  mesh.triangle(at_m + size_m * frame[0], at_m + size_m * (frame[1] - 0.5 * frame[0]),
                at_m - size_m * (frame[1] + 0.5 * frame[0]));
}

} // namespace

Scene lattice(std::uint32_t triangles) {
  constexpr std::uint32_t facets = 8;
  Mesh mesh;
  mesh.wall(-3.4);
  mesh.begin("rods", 0.6);
  const auto rods = static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / (3.0 * 4 * facets))));
  const glm::dvec3 centre_m(0.05, 0.02, -2.2), half_m(0.8, 0.8, 0.6);
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t i = 0; i < rods; ++i)
      for (std::uint32_t j = 0; j < rods; ++j) {
        glm::dvec3 half(0);
        half[axis] = half_m[axis];
        glm::dvec3 middle_m = centre_m;
        middle_m[(axis + 1) % 3] += half_m[(axis + 1) % 3] * centred(2 * i + 1, 2 * rods);
        middle_m[(axis + 2) % 3] += half_m[(axis + 2) % 3] * centred(2 * j + 1, 2 * rods);
        mesh.rod(middle_m - half, middle_m + half, 0.12 / rods, 0.12 / rods, facets);
      }
  return std::move(mesh).scene();
}

Scene blades(std::uint32_t triangles) {
  Random random(1);
  Mesh mesh;
  mesh.wall(-4.5);
  mesh.ground(-0.5);
  mesh.begin("blades", 0.5, true);
  while (mesh.triangles() < triangles)
    add_blade(mesh, random, place_on_ground(random, -0.5, 0.7, 4.2));
  return std::move(mesh).scene();
}

Scene forest(std::uint32_t triangles) {
  Random random(2);
  Mesh mesh;
  mesh.ground(-0.6);
  mesh.begin("trees", 0.3);
  std::vector<std::pair<glm::dvec3, double>> trees; // foot and height
  const auto count = static_cast<std::size_t>(std::max(2.0, std::sqrt(triangles / 70.0)));
  for (std::size_t i = 0; i < count; ++i) {
    trees.emplace_back(place_on_ground(random, -0.6, 1.6, 5.0), random.uniform(0.6, 1.4));
    add_tree(mesh, trees.back().first, trees.back().second);
  }
  mesh.begin("leaves", 0.6, true);
  while (mesh.triangles() < triangles) {
    const auto &[foot_m, height_m] = trees[random.below(trees.size())];
    add_leaf(mesh, random, foot_m, height_m);
  }
  return std::move(mesh).scene();
}

} // namespace pmdsim
