#pragma once
// A device against the reference, before its speed is believed.

#include "engine/measurement.h"
#include "engine/reference/reference.h"
#include "host/input/setup.h"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace pmdsim {

// Of one sensor at one frequency.
struct AccuracyCheck {
  std::string sensor;
  double modulation_hz = 0.0, ambiguity_m = 0.0;
  glm::uvec2 resolution{0, 0}; // of the frame that was compared
  std::size_t comparable = 0;  // pixels: bright enough in the reference
  std::size_t pixels = 0;      // of those compared: all their samples hit the same triangles on both
  std::size_t not_finite = 0;  // of those compared: the device gives no finite distance
  // Largest difference of the others' distances, wrapped; NaN where none is left.
  double distance_max_m = std::numeric_limits<double>::quiet_NaN();
};

// Pixels darker than a thousandth of the brightest, or of the brightest tap, are not comparable: where
// returns or taps cancel, the phase of what is left says nothing about the arithmetic. `found` holds its
// sample triangles, `truth` is of the same sensor.
AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor,
                      std::size_t frequency);

// Throws Error (internal) where a device that computes what the reference computes cannot have been the one
// that was compared: a distance is not finite or too far off, or hardly any pixel saw the same triangles.
void require_plausible(const AccuracyCheck &check, const std::string &device);

// With few enough pixels for what the reference can afford with so many diodes, one of `sensors` that share
// it. Where the fewest that coarser() leaves are too many still, with one sample a pixel.
Sensor affordable(Sensor sensor, std::size_t diode_count, std::size_t sensors);

// Measures every sensor's frame on both, or a coarser frame with the same view where the reference would take
// too long; a check each frequency. Throws Error.
std::vector<AccuracyCheck> check_accuracy(const Setup &setup, const std::string &device);

} // namespace pmdsim
