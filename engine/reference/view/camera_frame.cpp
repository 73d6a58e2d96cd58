#include "engine/reference/view/camera_frame.h"

namespace pmdsim::reference {

namespace {

// The lens is subtracted before anything is rotated: nearby world coordinates cancel exactly, however far
// away the world's origin is.
glm::dvec3 point_in_camera(const glm::dvec3 &position_world_m, const Pose &world_from_camera) {
  return glm::transpose(world_from_camera.rotation) * (position_world_m - world_from_camera.translation_m);
}

bool is_masked(const Surface &surface) { return surface.paint && surface.paint->alpha_cutoff > 0; }

} // namespace

std::vector<CameraTriangle> triangles_in_camera(const Scene &scene, const Sensor &sensor) {
  std::vector<glm::dvec3> vertices_m;
  vertices_m.reserve(scene.positions_m.size());
  for (const glm::dvec3 &position_m : scene.positions_m)
    vertices_m.push_back(point_in_camera(position_m, sensor.world_from_camera));

  std::vector<CameraTriangle> triangles;
  triangles.reserve(scene.triangles.size());
  for (const Triangle &triangle : scene.triangles) {
    const auto &[a, b, c] = triangle.vertices;
    const Surface &surface = scene.surfaces[triangle.surface];
    triangles.push_back(
        {{vertices_m[a], vertices_m[b], vertices_m[c]}, surface.double_sided, is_masked(surface)});
  }
  return triangles;
}

std::vector<CameraDisc> discs_in_camera(const Scene &scene, const Sensor &sensor) {
  std::vector<CameraDisc> discs;
  discs.reserve(scene.discs.size());
  for (const Disc &disc : scene.discs)
    discs.push_back({point_in_camera(scene.positions_m[disc.vertex], sensor.world_from_camera), disc.radius_m,
                     is_masked(scene.surfaces[disc.surface])});
  return discs;
}

std::vector<Diode> diodes_in_camera(const Illuminator &illuminator, const Sensor &sensor) {
  const Pose &world_from_camera = sensor.world_from_camera;
  const Pose &world_from_illuminator = illuminator.world_from_illuminator;
  const glm::dmat3 camera_from_world = glm::transpose(world_from_camera.rotation);
  const glm::dvec3 lens_to_illuminator_m =
      world_from_illuminator.translation_m - world_from_camera.translation_m;

  std::vector<Diode> diodes = illuminator.diodes;
  for (Diode &diode : diodes) {
    diode.position_m =
        camera_from_world * (world_from_illuminator.direction(diode.position_m) + lens_to_illuminator_m);
    diode.axis = camera_from_world * world_from_illuminator.direction(diode.axis);
    diode.across = camera_from_world * world_from_illuminator.direction(diode.across);
  }
  return diodes;
}

} // namespace pmdsim::reference
