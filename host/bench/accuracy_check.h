#pragma once
// A device against the reference, before its speed is believed.

#include "engine/reference/reference.h"
#include "host/input/setup/setup.h"

#include <limits>
#include <string>
#include <vector>

namespace pmdsim {

// The check of one sensor at one frequency.
struct AccuracyCheck {
  std::string sensor;
  double modulation_hz = 0.0, ambiguity_m = 0.0;
  glm::uvec2 resolution{0, 0}; // of the frame that was compared
  double claimed_m = 0.0;      // the error that the device's frame claims
  // Each sample that hits the same triangle on both is paired with every diode, dark or bright: the check is
  // whether the diode reaches it. None where shadows are off.
  std::size_t pairs = 0;
  std::size_t pairs_apart = 0;    // pairs that the device decides otherwise
  std::size_t comparable = 0;     // pixels: bright enough in the reference
  std::size_t same_triangles = 0; // of those: all their samples hit the same triangles on both
  std::size_t pixels = 0;         // of those compared: the same diodes reach them on both
  std::size_t not_finite = 0;     // of those compared: the device gives no finite distance
  std::size_t too_far = 0;        // of those compared: the distance is not plausible or not finite
  // Largest difference of the finite distances, wrapped; NaN where there is none.
  double distance_max_m = std::numeric_limits<double>::quiet_NaN();
};

// Pixels darker than a thousandth of the brightest, or of the brightest tap, are not comparable: where
// returns or taps cancel, the phase of what is left says nothing about the arithmetic. Where other diodes
// reach a pixel it measures another sum, which says nothing either. `found` and `truth` are of the same
// sensor in the light of `diodes`, with their sample triangles and, where shadows are automatic, with what
// reaches each sample. Throws Error (internal) where they are not.
AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor,
                      std::size_t frequency, std::size_t diodes);

// The error beyond which a device computes something else. It includes the error claimed; float32 itself
// holds a distance to 6e-8 of the ambiguity range.
double largest_plausible_error_m(double ambiguity_m, double claimed_m);

// Throws Error (internal) where a device that computes what the reference computes cannot have been the one
// that was compared: a distance is not finite or too far off, hardly any pixel saw the same triangles, or
// more samples than rounding explains have other diodes in sight.
void require_plausible(const AccuracyCheck &check, const std::string &device);

// The sensor with few enough pixels for what the reference can afford with so many diodes, with or without
// shadows, where `sensors` sensors share that. Where the fewest pixels that coarser() leaves are still too
// many, it takes one sample a pixel.
Sensor affordable(Sensor sensor, std::size_t diode_count, Shadows shadows, std::size_t sensors);

// The reference's frame of a sensor.
struct ReferenceFrame {
  Sensor sensor; // a coarser one with the same view where the setup's would take too long
  reference::Frame frame;
};

// The frames of every sensor of the setup. Throws Error (interrupted).
std::vector<ReferenceFrame> reference_frames(const Setup &setup);

// Measures the same frames on the device; a check each sensor and frequency. Throws Error.
std::vector<AccuracyCheck> check_accuracy(const Setup &setup, const std::vector<ReferenceFrame> &truth,
                                          const std::string &device, const Accuracy &accuracy);

} // namespace pmdsim
