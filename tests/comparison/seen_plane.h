#pragma once
// The plane of what a sample sees, camera frame, in double.

#include "engine/reference/view/camera_frame.h"

namespace pmdsim::test {

struct SeenPlane {
  glm::dvec3 point_m, normal; // unit length, to either side

  // Where a ray from the lens meets it.
  glm::dvec3 meeting_point_m(const glm::dvec3 &ray) const {
    return ray * (glm::dot(normal, point_m) / glm::dot(normal, ray));
  }
};

// The plane of the triangle or disc `id`, facing the lens; `triangles` are the scene's in the camera frame.
SeenPlane plane_of(std::uint32_t id, const Scene &scene, const Sensor &sensor,
                   const std::vector<reference::CameraTriangle> &triangles);

} // namespace pmdsim::test
