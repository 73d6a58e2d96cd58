#pragma once
// Whether a sensor's lens and chip can make an image, for people.

#include "engine/model/sensor.h"

#include <optional>
#include <string>

namespace pmdsim {

struct LensProblem {
  std::string key;         // of the sensor in a setup: "chip", "distortion" or "resolution"
  std::string expectation; // "expected ..."
};

// Nothing where every place of the image has a ray, no pixel sees too much of the scene and the chip's front
// is towards the lens.
std::optional<LensProblem> lens_problem(const Sensor &sensor);

} // namespace pmdsim
