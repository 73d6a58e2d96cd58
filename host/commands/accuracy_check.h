#pragma once
// A device against the reference, before its speed is believed.

#include "engine/measurement.h"
#include "engine/reference/reference.h"
#include "host/input/setup.h"

#include <cstddef>
#include <string>

namespace pmdsim {

struct AccuracyCheck {
  glm::uvec2 resolution{0, 0}; // of the frame that was compared
  std::size_t comparable = 0;  // pixels: bright enough in the reference
  std::size_t pixels = 0;      // of those compared: all their samples hit the same triangles on both
  std::size_t not_finite = 0;  // of those compared: the device gives no finite distance
  double distance_max_m = 0.0; // largest difference of the others' distances, wrapped; NaN where none is left
};

// Pixels darker than a thousandth of the brightest are not comparable: where returns cancel, the phase of
// what is left says nothing about the arithmetic. `found` holds its sample triangles, `truth` is of the same
// sensor.
AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor);

// Throws Error (internal) where a device that computes what the reference computes cannot have been the one
// that was compared: a distance is not finite or too far off, or hardly any pixel saw the same triangles.
void require_plausible(const AccuracyCheck &check, const Sensor &sensor, const std::string &device);

// Measures the first sensor's frame on both, or a coarser frame with the same view where the reference would
// take too long. Throws Error.
AccuracyCheck check_accuracy(const Setup &setup, const std::string &device);

} // namespace pmdsim
