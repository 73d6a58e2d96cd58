#include "host/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/noise.hpp>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double grid_per_m = 1 << 21;

} // namespace

double Random::uniform(double lower, double upper) {
  return lower + (upper - lower) * (static_cast<double>(engine_() >> 11) + 0.5) / 9007199254740992.0;
}

glm::dvec3 Random::in_box(const glm::dvec3 &lower, const glm::dvec3 &upper) {
  const double x = uniform(lower.x, upper.x);
  const double y = uniform(lower.y, upper.y);
  return {x, y, uniform(lower.z, upper.z)};
}

glm::dvec3 Random::unit_vector() {
  const double z = uniform(-1, 1);
  const double longitude_rad = uniform(0, 2 * std::numbers::pi);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(longitude_rad), radius * std::sin(longitude_rad), z};
}

double noise(const glm::dvec3 &point, int octaves) {
  double sum = 0.0, scale = 1.0, height = 1.0;
  for (int i = 0; i < octaves; ++i, scale *= 2.0, height *= 0.4)
    sum += height * glm::simplex(scale * point);
  return sum;
}

glm::dmat3 frame_along(const glm::dvec3 &direction) {
  const glm::dvec3 z = glm::normalize(direction);
  const glm::dvec3 x =
      glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
  return {x, glm::cross(z, x), z};
}

void Mesh::begin(const std::string &object, double reflectivity, bool double_sided) {
  scene_.objects.push_back(object);
  scene_.surfaces.push_back({reflectivity, double_sided});
}

std::uint32_t Mesh::vertex(const glm::dvec3 &position_m) {
  scene_.positions_m.push_back(glm::round(position_m * grid_per_m) / grid_per_m + 0.0); // -0 becomes 0
  return static_cast<std::uint32_t>(scene_.positions_m.size() - 1);
}

void Mesh::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::vector<glm::dvec3> &p = scene_.positions_m;
  const auto part = static_cast<std::uint32_t>(scene_.surfaces.size() - 1);
  if (glm::cross(p[b] - p[a], p[c] - p[a]) != glm::dvec3(0.0))
    scene_.triangles.push_back({{a, b, c}, part, part});
}

void Mesh::rod(const glm::dvec3 &from_m, const glm::dvec3 &to_m, double from_radius_m, double to_radius_m,
               std::uint32_t facets, std::uint32_t rows) {
  const glm::dmat3 frame = frame_along(to_m - from_m);
  const auto rim = [&](double u, double v) {
    const double angle_rad = std::numbers::pi * u, along = 0.5 + 0.5 * v;
    return glm::mix(from_m, to_m, along) +
           glm::mix(from_radius_m, to_radius_m, along) *
               (std::cos(angle_rad) * frame[0] + std::sin(angle_rad) * frame[1]);
  };
  sheet(facets, rows, rim);
  for (const double end : {-1.0, 1.0}) {
    const std::uint32_t centre = vertex(end < 0 ? from_m : to_m);
    for (std::uint32_t i = 0; i <= facets; ++i)
      vertex(rim(centred(i, facets), end));
    for (std::uint32_t i = centre + 1; i <= centre + facets; ++i)
      triangle(centre, end < 0 ? i + 1 : i, end < 0 ? i : i + 1);
  }
}

void Mesh::capsule(const glm::dvec3 &from_m, const glm::dvec3 &to_m, double radius_m, std::uint32_t facets,
                   std::uint32_t rows) {
  const glm::dmat3 frame = frame_along(to_m - from_m);
  sheet(facets, rows, [&](double u, double v) {
    // The middle third is the rod.
    const double past = std::max(std::abs(v) - 1.0 / 3.0, 0.0) * 1.5;
    const double latitude_rad = std::copysign(past * std::numbers::pi / 2, v);
    const double along = std::clamp(1.5 * v + 0.5, 0.0, 1.0), angle_rad = std::numbers::pi * u;
    return glm::mix(from_m, to_m, along) +
           radius_m *
               (std::cos(latitude_rad) * (std::cos(angle_rad) * frame[0] + std::sin(angle_rad) * frame[1]) +
                std::sin(latitude_rad) * frame[2]);
  });
}

void Mesh::box(const glm::dvec3 &centre_m, const glm::dmat3 &axes_m) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      sheet(1, 1, [&](double u, double v) {
        return centre_m + sign * axes_m[axis] + sign * u * axes_m[(axis + 1) % 3] +
               v * axes_m[(axis + 2) % 3];
      });
}

void Mesh::wall(double z_m) {
  begin("wall", 0.8);
  sheet(1, 1, [&](double u, double v) { return glm::dvec3(0.6 * u * -z_m, 0.6 * v * -z_m, z_m); });
}

void Mesh::ground(double y_m) {
  begin("ground", 0.4);
  sheet(1, 1, [&](double u, double v) { return glm::dvec3(3.6 * u, y_m, -3.1 - 2.9 * v); });
}

} // namespace pmdsim
