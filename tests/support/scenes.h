#pragma once
// Small scenes, cameras and lights for tests, built from shapes in the camera's frame (x right, y down, z
// forward).

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

namespace pmdsim::test {

// A rectangle across the optical axis, its front towards the lens.
struct Wall {
  double z_m;
  Surface surface{};
  glm::dvec2 lower_m{-10.0, -10.0};
  glm::dvec2 upper_m{10.0, 10.0};
};

// Each shape becomes an object and a surface of its own.
class SceneBuilder {
public:
  explicit SceneBuilder(const Pose &world_from_camera = node_from_camera())
      : world_from_camera_(world_from_camera) {}

  // Front where a, b, c run counter-clockwise. Returns the triangle's id.
  std::uint32_t add_triangle(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c,
                             const Surface &surface = {});
  void add_wall(const Wall &wall);
  // Faces are triples of indices into `corners_m`, counter-clockwise seen from the front.
  void add_mesh(const std::vector<glm::dvec3> &corners_m,
                const std::vector<std::array<std::uint32_t, 3>> &faces, const Surface &surface = {});

  const Scene &scene() const { return scene_; }

private:
  Pose world_from_camera_;
  Scene scene_;
};

Scene wall_at(double z_m, const Surface &surface = {});

// Pixels so small against the focal length (1 microradian each) that the whole image lies on the optical
// axis: at distance z, r_n differs from z by less than 1e-11 * z.
Sensor axial_sensor(const glm::uvec2 &resolution = {1, 1});

// One diode in the sensor's camera frame.
Illuminator diode_beside_lens(const Sensor &sensor, const Diode &diode);

// An isotropic diode of 1 W/sr.
Diode diode_at(const glm::dvec3 &position_m);

inline Pattern cosine(double order) { return {Pattern::Kind::cosine, order}; }

} // namespace pmdsim::test
