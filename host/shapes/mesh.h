#pragma once
// Meshes of triangles, put together from parts: what procedural scenes are made of.

#include "engine/model/scene.h"

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <utility>

namespace pmdsim {

// The same values with every standard library.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double lower, double upper);
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  glm::dvec3 in_box(const glm::dvec3 &lower, const glm::dvec3 &upper);
  glm::dvec3 unit_vector();

private:
  std::mt19937_64 engine_;
};

// Smooth noise of up to 1 at about 1/m, and 0.4 times as much for each further octave.
double noise(const glm::dvec3 &point, int octaves);

// A right-handed frame whose last axis is along `direction`.
glm::dmat3 frame_along(const glm::dvec3 &direction);

// -1 to 1; that of `count - i` is its negative to the last bit.
inline double centred(std::uint32_t i, std::uint32_t count) {
  return (2.0 * i - count) / static_cast<double>(count);
}

class Mesh {
public:
  // All that is added from here on is of this object and surface.
  void begin(const std::string &object, double reflectivity, bool double_sided = false);

  // A vertex on a grid of 2^-21 m, which float32 holds to 8 m: files have the same places, and parts that
  // meet do so to the last bit.
  std::uint32_t vertex(const glm::dvec3 &position_m);
  // Counter-clockwise where its front is seen; nothing where it has no area.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void triangle(const glm::dvec3 &a_m, const glm::dvec3 &b_m, const glm::dvec3 &c_m) {
    const std::uint32_t a = vertex(a_m), b = vertex(b_m);
    triangle(a, b, vertex(c_m));
  }
  // Two triangles each of columns x rows cells through point_m(u, v), u and v from -1 to 1; its front is
  // where u grows to the right and v upwards.
  void sheet(std::uint32_t columns, std::uint32_t rows, const auto &point_m);
  // A closed surface of 12 cells^2 triangles through point_m(direction) in all directions from within.
  void ball(std::uint32_t cells, const auto &point_m);
  void sphere(const glm::dvec3 &centre_m, double radius_m, std::uint32_t cells) {
    ball(cells, [&](const glm::dvec3 &direction) { return centre_m + radius_m * direction; });
  }
  // A closed cylinder or cone of 2 facets (rows + 1) triangles, of 2 facets less where it has a point.
  void rod(const glm::dvec3 &from_m, const glm::dvec3 &to_m, double from_radius_m, double to_radius_m,
           std::uint32_t facets, std::uint32_t rows = 1);
  // A rod with half a sphere at each end, of 2 facets (rows - 1) triangles.
  void capsule(const glm::dvec3 &from_m, const glm::dvec3 &to_m, double radius_m, std::uint32_t facets,
               std::uint32_t rows);
  // A box of 12 triangles; `axes_m` are half its edges.
  void box(const glm::dvec3 &centre_m, const glm::dmat3 &axes_m);
  void box(const glm::dvec3 &centre_m, const glm::dvec3 &half_m) {
    box(centre_m, glm::dmat3(half_m.x, 0, 0, 0, half_m.y, 0, 0, 0, half_m.z));
  }
  // Two triangles each: an upright wall that more than fills a view of +-0.5; level ground, to 6 m from the
  // lens.
  void wall(double z_m);
  void ground(double y_m);

  std::size_t triangles() const { return scene_.triangles.size(); }
  Scene scene() && { return std::move(scene_); }

private:
  Scene scene_;
};

void Mesh::sheet(std::uint32_t columns, std::uint32_t rows, const auto &point_m) {
  const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x)
      vertex(point_m(centred(x, columns), centred(y, rows)));
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t corner = first + y * (columns + 1) + x, above = corner + columns + 1;
      triangle(corner, corner + 1, above + 1);
      triangle(corner, above + 1, above);
    }
}

void Mesh::ball(std::uint32_t cells, const auto &point_m) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      glm::dvec3 out(0), right(0), up(0);
      out[axis] = sign;
      right[(axis + 1) % 3] = sign;
      up[(axis + 2) % 3] = 1;
      sheet(cells, cells,
            [&](double u, double v) { return point_m(glm::normalize(out + u * right + v * up)); });
    }
}

} // namespace pmdsim
