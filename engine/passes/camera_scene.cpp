#include "engine/passes/camera_scene.h"

#include "engine/passes/double_pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace pmdsim {
namespace {

// Empty where the lens cannot see the triangle from where it stands.
std::optional<Plane> visible_plane(const std::array<glm::dvec3, 3> &corners_m, bool double_sided) {
  const glm::dvec3 area = glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]);
  const double length = glm::length(area);
  if (!(length > 0.0))
    return std::nullopt;
  const glm::dvec3 normal = area / length;
  const double offset_m = glm::dot(normal, corners_m[0]);
  if (offset_m == 0.0 || (offset_m > 0.0 && !double_sided))
    return std::nullopt;
  return offset_m < 0.0 ? Plane{normal, offset_m} : Plane{-normal, -offset_m};
}

} // namespace

CameraScene to_camera(const Scene &scene, const Sensor &sensor) {
  const Pose &world_from_camera = sensor.world_from_camera;
  const glm::dmat3 camera_from_world = glm::transpose(world_from_camera.rotation);
  CameraScene camera;
  camera.triangles.reserve(scene.triangles.size());
  camera.planes.reserve(scene.triangles.size());
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
    const Triangle &triangle = scene.triangles[id];
    CameraTriangle seen{{}, id};
    // The lens is taken off first: what is left is small, wherever in the world the scene stands.
    for (std::size_t k = 0; k < 3; ++k)
      seen.corners_m[k] =
          camera_from_world * (scene.positions_m[triangle.vertices[k]] - world_from_camera.translation_m);
    if (const auto plane = visible_plane(seen.corners_m, scene.surfaces[triangle.surface].double_sided)) {
      camera.triangles.push_back(seen);
      camera.planes.push_back(*plane);
    }
  }
  return camera;
}

std::vector<Diode> to_camera(const Illuminator &illuminator, const Sensor &sensor) {
  const Pose camera_from_illuminator =
      compose(inverse(sensor.world_from_camera), illuminator.world_from_illuminator);
  std::vector<Diode> diodes = illuminator.diodes;
  for (Diode &diode : diodes) {
    diode.position_m = camera_from_illuminator.point(diode.position_m);
    diode.axis = camera_from_illuminator.direction(diode.axis);
  }
  return diodes;
}

std::vector<shader::TrianglePlane> triangle_planes(const CameraScene &camera, const Scene &scene,
                                                   Backscatter backscatter) {
  // A hair wider than the triangle, so that rounding to float never clamps a true hit.
  constexpr double slack = 1e-6;
  const double per_reflectivity = backscatter == Backscatter::lambert ? std::numbers::inv_pi : 1.0;
  std::vector<shader::TrianglePlane> records(scene.triangles.size());
  for (std::size_t i = 0; i < camera.triangles.size(); ++i) {
    const auto &[corners_m, id] = camera.triangles[i];
    const Plane &plane = camera.planes[i];
    const auto [nearest, farthest] = std::minmax({corners_m[0].z, corners_m[1].z, corners_m[2].z});
    const Triangle &triangle = scene.triangles[id];
    const DoublePair4 pair(plane.normal, plane.offset_m);
    records[id] = {pair.hi,
                   pair.lo,
                   static_cast<float>(scene.surfaces[triangle.surface].reflectivity * per_reflectivity),
                   triangle.object,
                   static_cast<float>(std::max(0.0, nearest) * (1.0 - slack)),
                   static_cast<float>(std::max(0.0, farthest) * (1.0 + slack))};
  }
  return records;
}

bool all_face_the_light(const CameraScene &camera, const std::vector<Diode> &camera_diodes) {
  glm::dvec3 low(camera_diodes.front().position_m), high(low);
  for (const Diode &diode : camera_diodes) {
    low = glm::min(low, diode.position_m);
    high = glm::max(high, diode.position_m);
  }
  const glm::dvec3 centre = 0.5 * (low + high);
  const double radius_m = glm::distance(centre, high);
  return std::ranges::all_of(camera.planes, [&](const Plane &plane) {
    return glm::dot(plane.normal, centre) - plane.offset_m > radius_m;
  });
}

} // namespace pmdsim
