#pragma once
// Scene, light and sample rays in the camera's frame (x right, y down, z forward, origin at the lens centre),
// in double.

#include "engine/illuminator.h"
#include "engine/scene.h"
#include "engine/sensor.h"

#include <array>
#include <vector>

namespace pmdsim::reference {

// A triangle with its corners in metres from the lens. Triangles that share a vertex hold the same bits for
// it.
struct CameraTriangle {
  std::array<glm::dvec3, 3> corners_m;
  double reflectivity;
  bool double_sided;

  // Not normalised; towards the lens where the lens sees the front.
  glm::dvec3 front() const { return glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]); }
};

std::vector<CameraTriangle> triangles_in_camera(const Scene &scene, const Sensor &sensor);

// The illuminator's diodes with position and axis in the camera's frame.
std::vector<Diode> diodes_in_camera(const Illuminator &illuminator, const Sensor &sensor);

// The ray of one sample, as LensModel gives it; throws std::bad_optional_access where the sample sees
// nothing.
glm::dvec3 sample_ray(const Sensor &sensor, const glm::uvec2 &sample);

} // namespace pmdsim::reference
