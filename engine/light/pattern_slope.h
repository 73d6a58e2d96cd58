#pragma once
// How fast the light of diodes changes with the direction.

#include "engine/light/camera_light.h"
#include "engine/view/view_bounds.h"

#include <vector>

namespace pmdsim {

// The largest slope of ln J, per radian, and such that its square bounds the curvature; over the diodes and
// what they shine on, `visible`. Infinite where a diagram has edges or what is visible is beside a cosine's
// beam.
double pattern_slope(const std::vector<CameraIlluminator> &illuminators,
                     const std::vector<VisibleBox> &visible);

} // namespace pmdsim
