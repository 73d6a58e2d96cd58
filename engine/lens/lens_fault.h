#pragma once
// Whether every pixel of a sensor has a ray.

#include "engine/model/sensor.h"

#include <optional>

namespace pmdsim {

// What makes a sensor's image impossible; nothing where every place of it has a ray.
enum class LensFault {
  chip_behind_lens,
  distortion_folds,
  beyond_model,   // Brown-Conrady 89 degrees off the axis, a fisheye 179.4: no fold, but the model ends
  pixel_too_wide, // distortion: a pixel sees a ray 60 degrees or more off the mean of its rays
};
std::optional<LensFault> lens_fault(const Sensor &sensor);

} // namespace pmdsim
