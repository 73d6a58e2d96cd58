#pragma once
// Where light is scattered.

#include <glm/glm.hpp>

namespace pmdsim::reference {

// A point that the lens sees, or that another surface sees, camera frame.
struct SurfacePoint {
  glm::dvec3 position_m;
  glm::dvec3 normal; // unit length, turned to who sees it
  double reflectivity;
  double lens_gain; // the part of its light that vignetting leaves
};

} // namespace pmdsim::reference
