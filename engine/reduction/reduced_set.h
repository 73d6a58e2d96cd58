#pragma once
// Few diodes with other intensities in place of many, within an error that follows from theory.

#include "engine/light/camera_light.h"

#include <vector>

namespace pmdsim {

// The bound holds for every sum of returns from visible points whose surfaces have all of `lights` in front
// of them and that all diodes reach: with condition = sum|terms| / |sum| over all samples and diodes and
// relative = amplitude_error_per_condition * condition < 1, the wrapped distance is off by at most
// error_per_condition_m * condition / (1 - relative) and the amplitude by the factor 1 +- relative.
struct ReducedLight {
  std::vector<CameraIlluminator> illuminators; // some of the given diodes in their order, intensities >= 0
  VisibleBox lights;                           // camera frame; holds all given diodes
  double error_per_condition_m = 0.0;
  double amplitude_error_per_condition = 0.0;
};

// All diodes for themselves.
ReducedLight whole_light(const std::vector<CameraIlluminator> &illuminators);

// As few diodes as keep the errors within the two at condition 1 (amplitude also within 10^-3, so that
// `relative` is small). Diodes stay as they are where that gains nothing or visible points are too near.
// `visible` bounds the points, camera frame; wavenumbers are 2 pi f / c of all modulation frequencies. The
// same input gives the same result.
ReducedLight reduce_diodes(const std::vector<CameraIlluminator> &illuminators,
                           const std::vector<VisibleBox> &visible, Backscatter backscatter,
                           std::vector<double> wavenumbers_rad_m, double max_error_m,
                           double max_amplitude_error);

} // namespace pmdsim
