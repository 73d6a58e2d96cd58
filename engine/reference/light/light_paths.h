#pragma once
// The terms of the paper's eq. 5 to 7: the ways that light takes from the diodes through one point of the
// scene to the lens.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/reference/light/diode_set.h"

#include <vector>

namespace pmdsim::reference {

// A point that the lens sees, camera frame.
struct SurfacePoint {
  glm::dvec3 position_m;
  glm::dvec3 normal; // unit length, turned to the lens
  double reflectivity;
  double lens_gain; // what vignetting leaves of its light
};

struct LightPath {
  double length_m;          // r_nm + r_n
  double weight_w_m2_sr;    // lens_gain * B * I * J / r_nm^2
  double phase_turns = 0.0; // added to what the length makes of it, -1/2 to 1/2
};

// Diodes of one phase, camera frame.
struct Light {
  std::vector<Diode> diodes;
  double phase_turns; // -1/2 to 1/2
};

// Of every diode of `reached` whose light returns through `point`.
std::vector<LightPath> light_paths(const SurfacePoint &point, const std::vector<Light> &lights,
                                   const DiodeSet &reached, Backscatter backscatter);

} // namespace pmdsim::reference
