#pragma once
// Rooms with boxes and balls, the lens and its light inside: the same for the same number.

#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace pmdsim::test {

struct Room {
  Scene scene;
  Sensor sensor;
  Illuminator light;
};

// The corners of a box, turned about the vertical axis.
inline std::vector<glm::dvec3> box_corners(const glm::dvec3 &centre_m, const glm::dvec3 &half_m,
                                           double turn_rad) {
  std::vector<glm::dvec3> corners_m;
  for (const double z : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double x : {-1.0, 1.0}) {
        const glm::dvec3 p = glm::dvec3(x, y, z) * half_m;
        corners_m.push_back(centre_m + glm::dvec3(std::cos(turn_rad) * p.x - std::sin(turn_rad) * p.z, p.y,
                                                  std::sin(turn_rad) * p.x + std::cos(turn_rad) * p.z));
      }
  return corners_m;
}

// Fronts outside, or inside.
inline std::vector<std::array<std::uint32_t, 3>> box_faces(bool inside) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  const std::array<std::array<std::uint32_t, 4>, 6> quads{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto &[a, b, c, d] : quads)
    for (std::array<std::uint32_t, 3> face : {std::array{a, b, c}, std::array{a, c, d}}) {
      if (inside)
        std::swap(face[1], face[2]);
      faces.push_back(face);
    }
  return faces;
}

inline void add_ball(SceneBuilder &builder, const glm::dvec3 &centre_m, double radius_m, std::uint32_t rings,
                     const Surface &surface) {
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  const std::uint32_t columns = 2 * rings;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double t = std::numbers::pi * i / rings, p = 2.0 * std::numbers::pi * j / columns;
      corners_m.push_back(centre_m + radius_m * glm::dvec3(std::sin(t) * std::cos(p), std::cos(t),
                                                           std::sin(t) * std::sin(p)));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns, c = a + columns,
                          d = b + columns;
      if (i > 0)
        faces.push_back({a, b, c});
      if (i + 1 < rings)
        faces.push_back({b, d, c});
    }
  for (auto &face : faces) { // their fronts outside
    const auto &[a, b, c] = face;
    const glm::dvec3 front = glm::cross(corners_m[b] - corners_m[a], corners_m[c] - corners_m[a]);
    if (glm::dot(front, corners_m[a] - centre_m) < 0.0)
      std::swap(face[1], face[2]);
  }
  builder.add_mesh(corners_m, faces, surface);
}

// In the camera's frame (y down): walls around the lens, boxes on the floor, balls above them.
inline Room random_room(std::uint32_t number) {
  Random random(4711 + number);
  SceneBuilder builder;
  const auto surface = [&] { return Surface{random.uniform(0.2, 0.85), random.flip(), std::nullopt}; };
  const glm::dvec3 half_m(random.uniform(0.6, 2.5), random.uniform(0.5, 1.5), random.uniform(0.8, 2.5));
  const double back_m = random.uniform(0.2, 0.9); // of the wall behind the lens
  const glm::dvec3 centre_m(random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.2), half_m.z - back_m);
  auto faces = box_faces(true);
  if (random.flip()) // without the wall behind the lens
    faces.erase(faces.begin(), faces.begin() + 2);
  for (std::size_t i = 0; i < faces.size(); i += 2) // each wall has a reflectivity of its own
    builder.add_mesh(box_corners(centre_m, half_m, 0.0), {faces[i], faces[i + 1]},
                     {random.uniform(0.2, 0.85)});
  const double floor_m = centre_m.y + half_m.y;
  for (int i = 0; i < 2; ++i) {
    const glm::dvec3 size_m(random.uniform(0.08, 0.3), random.uniform(0.1, 0.35), random.uniform(0.08, 0.3));
    builder.add_mesh(box_corners({random.uniform(-0.6, 0.6) * half_m.x, floor_m - size_m.y,
                                  random.uniform(0.5, 0.95) * (2.0 * half_m.z - back_m)},
                                 size_m, random.uniform(0.0, 1.5)),
                     box_faces(false), surface());
  }
  add_ball(builder,
           {random.uniform(-0.5, 0.5) * half_m.x, random.uniform(-0.4, 0.2),
            random.uniform(0.6, 0.9) * (2.0 * half_m.z - back_m)},
           random.uniform(0.1, 0.25), 10, surface());
  Room room{builder.scene(), {}, {}};
  room.sensor.resolution = {24, 18};
  room.sensor.focal_length_m = 0.01;
  room.sensor.pixel_pitch_m = glm::dvec2(random.uniform(0.9, 1.8) * room.sensor.focal_length_m / 24.0);
  room.light = {"light", room.sensor.world_from_camera, {}};
  for (int i = 0; i < 12; ++i) {
    Diode diode = diode_at({0.05 * std::cos(0.5 * i), 0.05 * std::sin(0.5 * i), 0.0});
    diode.pattern = cosine(random.uniform(0.0, 3.0));
    room.light.diodes.push_back(diode);
  }
  return room;
}

} // namespace pmdsim::test
