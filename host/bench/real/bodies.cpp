// Smooth and rough bodies before a wall, and hills.
#include "host/bench/real/kinds.h"
#include "host/shapes/mesh.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

// The cells of a ball of about that many triangles.
std::uint32_t cells_of(std::uint32_t triangles) {
  return static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / 12.0)));
}

// radius_m(direction) all around the centre.
Scene body_before_wall(std::uint32_t triangles, const glm::dvec3 &centre_m, double wall_z_m,
                       const auto &radius_m, bool double_sided = false) {
  Mesh mesh;
  mesh.wall(wall_z_m);
  mesh.begin("body", 0.6, double_sided);
  mesh.ball(cells_of(triangles),
            [&](const glm::dvec3 &direction) { return centre_m + radius_m(direction) * direction; });
  return std::move(mesh).scene();
}

// Rough, with a scanner's noise of less than `noise_m`.
double rough_radius_m(const glm::dvec3 &direction, double radius_m, double noise_m) {
  const double shape = 1 + 0.2 * noise(1.2 * direction + 7.0, 8);
  return radius_m * shape + noise_m * noise(3000.0 * direction, 1);
}

struct Bump {
  glm::dvec3 direction;
  double width, height; // of its Gauss, in the direction's units; negative: a hollow
};

} // namespace

Scene blob(std::uint32_t triangles) {
  return body_before_wall(triangles, {0, 0, -2}, -3.2, [](const glm::dvec3 &direction) {
    return 0.62 + 0.14 * noise(1.1 * direction, 1);
  });
}

Scene scan(std::uint32_t triangles) {
  return body_before_wall(triangles, {0.1, 0, -1.8}, -2.8, [](const glm::dvec3 &direction) {
    return rough_radius_m(direction, 0.55, 0.4e-3);
  });
}

Scene close_body(std::uint32_t triangles) {
  return body_before_wall(triangles, {0.02, 0.01, -0.29}, -1.5, [](const glm::dvec3 &direction) {
    return rough_radius_m(direction, 0.07, 0.05e-3);
  });
}

Scene head(std::uint32_t triangles) {
  static const std::array<Bump, 9> bumps{{{{0, -0.1, 1}, 0.13, 0.16},        // nose
                                          {{-0.33, 0.13, 0.9}, 0.13, -0.14}, // sockets
                                          {{0.33, 0.13, 0.9}, 0.13, -0.14},
                                          {{0, -0.5, 0.85}, 0.10, -0.12}, // mouth
                                          {{0, -0.8, 0.7}, 0.2, 0.10},    // chin
                                          {{-1, 0, 0.1}, 0.12, 0.14},     // ears
                                          {{1, 0, 0.1}, 0.12, 0.14},
                                          {{-0.7, -0.35, 0.65}, 0.2, -0.08}, // cheeks
                                          {{0.7, -0.35, 0.65}, 0.2, -0.08}}};
  return body_before_wall(triangles, {-0.1, 0, -1.6}, -2.2, [](const glm::dvec3 &direction) {
    double radius_m = 0.42 / std::sqrt(1 - 0.35 * direction.y * direction.y);
    for (const auto &[centre, width, height] : bumps) {
      const glm::dvec3 away = (direction - glm::normalize(centre)) / width;
      radius_m += height * std::exp(-0.5 * glm::dot(away, away));
    }
    return radius_m;
  });
}

Scene flipped(std::uint32_t triangles) {
  Scene scene = body_before_wall(
      triangles, {0, 0, -2}, -3.2,
      [](const glm::dvec3 &direction) { return rough_radius_m(direction, 0.6, 0.0); }, true);
  Random random(5);
  for (Triangle &triangle : scene.triangles)
    if (scene.surfaces[triangle.surface].double_sided && random.below(2) == 0)
      std::swap(triangle.vertices[1], triangle.vertices[2]);
  return scene;
}

Scene knot(std::uint32_t triangles) {
  Mesh mesh;
  mesh.wall(-3.3);
  mesh.begin("knot", 0.6);
  const auto centre_m = [](double t) {
    const double radius_m = 0.42 + 0.2 * std::cos(3 * t);
    return glm::dvec3(radius_m * std::cos(2 * t), radius_m * std::sin(2 * t), -2.2 + 0.25 * std::sin(3 * t));
  };
  const auto around = static_cast<std::uint32_t>(std::sqrt(triangles / 24.0));
  mesh.sheet(around, triangles / (2 * around), [&](double u, double v) {
    const double t = std::numbers::pi * v, angle_rad = std::numbers::pi * u;
    const glm::dvec3 along = centre_m(t + 1e-4) - centre_m(t - 1e-4);
    const glm::dmat3 frame = frame_along(along);
    return centre_m(t) + 0.11 * (std::cos(angle_rad) * frame[0] + std::sin(angle_rad) * frame[1]);
  });
  return std::move(mesh).scene();
}

Scene terrain(std::uint32_t triangles) {
  Mesh mesh;
  mesh.begin("hills", 0.5);
  const auto cells = static_cast<std::uint32_t>(std::sqrt(triangles / 2.0));
  mesh.sheet(cells, cells, [](double u, double v) {
    const double x_m = 3.0 * u, z_m = -3.0 - 2.5 * v;
    const double rise_m = -0.55 + 0.12 * (-0.5 - z_m);
    return glm::dvec3(x_m, rise_m + 0.35 * noise({0.8 * x_m, 0.8 * z_m, 3.0}, 9), z_m);
  });
  return std::move(mesh).scene();
}

} // namespace pmdsim
