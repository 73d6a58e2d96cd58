#include "tests/comparison/seen_plane.h"

namespace pmdsim::test {

SeenPlane plane_of(std::uint32_t id, const Scene &scene, const Sensor &sensor,
                   const std::vector<reference::CameraTriangle> &triangles) {
  if (id < scene.triangles.size())
    return {triangles[id].corners_m[0], glm::normalize(triangles[id].front())};
  const Disc &disc = scene.discs[id - scene.triangles.size()];
  const glm::dvec3 centre_m = inverse(sensor.world_from_camera).point(scene.positions_m[disc.vertex]);
  return {centre_m, -glm::normalize(centre_m)};
}

} // namespace pmdsim::test
