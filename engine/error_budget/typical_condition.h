#pragma once
// How much the returns of a pixel cancel, as a rule: by this a precision is chosen. No bound rests on it.

#include "engine/light/camera_light.h"
#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

// The median over places in what is visible of sum |w| / |sum w exp(j 2 kappa path)|, in the light of all
// diodes, whatever stands in between and however surfaces are turned; 1 where nothing is visible or lit.
// Measured diagrams count as if they were the same all around.
double typical_condition(const std::vector<CameraIlluminator> &lights, const std::vector<VisibleBox> &visible,
                         double wavenumber_rad_m);

} // namespace pmdsim
