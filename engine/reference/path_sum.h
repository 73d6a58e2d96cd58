#pragma once
// The inner sum of the paper's eq. 5 to 7: what all diodes return through one point of the scene.

#include "engine/illuminator.h"
#include "engine/reference/compensated_sum.h"
#include "engine/scene.h"

#include <vector>

namespace pmdsim::reference {

// A point that the lens sees, camera frame.
struct SurfacePoint {
  glm::dvec3 position_m;
  glm::dvec3 normal; // unit length, turned to the lens
  double reflectivity;
};

// Adds B * I * J / r_nm^2 * exp(+j 2 pi (r_nm + r_n) / lambda), W/(m^2 sr), for every diode (camera frame) to
// `z`.
void add_paths(ComplexSum &z, const SurfacePoint &point, const std::vector<Diode> &diodes,
               Backscatter backscatter, double modulation_hz);

} // namespace pmdsim::reference
