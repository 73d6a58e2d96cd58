#include "tests/support/scenes.h"

namespace pmdsim::test {

std::uint32_t SceneBuilder::add_triangle(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c,
                                         const Surface &surface) {
  add_mesh({a, b, c}, {{0, 1, 2}}, surface);
  return static_cast<std::uint32_t>(scene_.triangles.size() - 1);
}

void SceneBuilder::add_wall(const Wall &wall) {
  const auto &[z_m, surface, lower_m, upper_m] = wall;
  add_mesh({{lower_m.x, lower_m.y, z_m},
            {lower_m.x, upper_m.y, z_m},
            {upper_m.x, upper_m.y, z_m},
            {upper_m.x, lower_m.y, z_m}},
           {{0, 1, 2}, {0, 2, 3}}, surface);
}

void SceneBuilder::add_mesh(const std::vector<glm::dvec3> &corners_m,
                            const std::vector<std::array<std::uint32_t, 3>> &faces, const Surface &surface) {
  const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
  const auto surface_index = static_cast<std::uint32_t>(scene_.surfaces.size());
  const auto object = static_cast<std::uint32_t>(scene_.objects.size());
  for (const glm::dvec3 &corner_m : corners_m)
    scene_.positions_m.push_back(world_from_camera_.point(corner_m));
  for (const auto &[a, b, c] : faces)
    scene_.triangles.push_back({{first + a, first + b, first + c}, surface_index, object});
  scene_.surfaces.push_back(surface);
  scene_.objects.push_back("shape " + std::to_string(object));
}

Scene wall_at(double z_m, const Surface &surface) {
  SceneBuilder builder;
  builder.add_wall({z_m, surface});
  return builder.scene();
}

Sensor axial_sensor(const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.pixel_pitch_m = glm::dvec2(1e-6);
  sensor.focal_length_m = 1.0;
  return sensor;
}

Illuminator diode_beside_lens(const Sensor &sensor, const Diode &diode) {
  return {"diode", sensor.world_from_camera, {diode}};
}

Diode diode_at(const glm::dvec3 &position_m) {
  Diode diode;
  diode.position_m = position_m;
  return diode;
}

} // namespace pmdsim::test
