#pragma once
// Scene and light in the camera's frame (x right, y down, z forward, origin at the lens centre), in double.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <array>
#include <vector>

namespace pmdsim::reference {

// A triangle with its corners in metres from the lens. Triangles that share a vertex hold the same bits for
// it.
struct CameraTriangle {
  std::array<glm::dvec3, 3> corners_m;
  bool double_sided;
  bool cutouts = false; // its paint may leave parts of it out

  // Not normalised; towards the lens where the lens sees the front.
  glm::dvec3 front() const { return glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]); }
};

// A disc with its centre in metres from the lens, which it faces. One about the lens itself is not there.
struct CameraDisc {
  glm::dvec3 centre_m;
  double radius_m;
  bool cutouts = false;

  // Unit length, from the lens to the centre; zero where they are one.
  glm::dvec3 axis() const {
    const double distance_m = glm::length(centre_m);
    return distance_m > 0 ? centre_m / distance_m : glm::dvec3(0.0);
  }
};

std::vector<CameraTriangle> triangles_in_camera(const Scene &scene, const Sensor &sensor);
std::vector<CameraDisc> discs_in_camera(const Scene &scene, const Sensor &sensor);

// The illuminator's diodes with position, axis and `across` in the camera's frame.
std::vector<Diode> diodes_in_camera(const Illuminator &illuminator, const Sensor &sensor);

} // namespace pmdsim::reference
