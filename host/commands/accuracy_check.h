#pragma once
// A device against the reference, before its speed is believed.

#include "host/input/setup.h"

#include <cstddef>
#include <string>

namespace pmdsim {

struct AccuracyCheck {
  glm::uvec2 resolution{0, 0}; // of the frame that was compared
  std::size_t pixels = 0;      // compared: those whose samples all hit the same triangles on both
  double distance_max_m = 0.0; // largest difference of distances, wrapped; NaN where no pixel compares
};

// Measures the first sensor's frame on both, or a coarser frame with the same view where the reference would
// take too long. Pixels darker than a thousandth of the brightest are left out: where returns cancel, the
// phase of what is left says nothing about the arithmetic. Throws Error.
AccuracyCheck check_accuracy(const Setup &setup, const std::string &device);

} // namespace pmdsim
