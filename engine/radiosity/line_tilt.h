#pragma once
// How light that arrives on a surface changes when the surface tilts: towards a direction d in it by the
// integral of L (omega . d), where the light itself is that of L (omega . n). What rises or sets at the
// horizon does not count to first order (J. Arvo, "The irradiance Jacobian for partially occluded polyhedral
// sources", SIGGRAPH 1994).

#include "engine/radiosity/line_light.h"
#include "engine/surfaces/surface_frame.h"

namespace pmdsim {

// The change by each part of a line, over that part: `of_line`, and `of_bins` times the cotangent of the
// bin's angle from the axis.
struct LineTilt {
  float of_line, of_bins;

  Phasor of(const LineLight &light) const { return of_line * light.arrives + of_bins * light.along; }
};

// Towards `direction`, of which the part in the surface counts.
inline LineTilt tilt_towards(const glm::dvec3 &direction, const SurfaceFrame &frame, const SeenLine &line) {
  return {static_cast<float>(glm::dot(frame.y, direction)) * line.cosine / line.sine,
          static_cast<float>(glm::dot(frame.x, direction)) / line.sine};
}

} // namespace pmdsim
