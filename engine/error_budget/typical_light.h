#pragma once
// The light of most pixels, by which a precision is chosen. No bound rests on it.

#include "engine/light/camera_light.h"
#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

// Over places that are lit, in the light of all diodes, whatever stands in between and
// however surfaces are turned. Measured diagrams count as if they were the same all around.
struct TypicalLight {
  double condition = 1.0; // the median of sum |w| / |sum w exp(j 2 kappa path)|
  // Of -ln J, J the mean of the diodes': the median, and what nine of ten places are below.
  double dimming = 0.0, dimming_of_most = 0.0;
};

// Nothing cancels or dims where nothing is lit. Some 64 of the places are looked at.
TypicalLight typical_light_at(const std::vector<glm::dvec3> &places_m,
                              const std::vector<CameraIlluminator> &lights, double wavenumber_rad_m);

// In the middles of what is visible.
TypicalLight typical_light(const std::vector<CameraIlluminator> &lights,
                           const std::vector<VisibleBox> &visible, double wavenumber_rad_m);

} // namespace pmdsim
