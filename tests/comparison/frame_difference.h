#pragma once
// Two frames of the same scene, summed in different ways.

#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

namespace pmdsim::test {

// The largest differences over all pixels and frequencies.
struct FrameDifference {
  double distance_m = 0.0;       // wrapped
  double amplitude = 0.0;        // relative
  double taps = 0.0;             // relative to the amplitude
  double truth_m = 0.0;          // of range_m and z_m
  std::size_t lit = 0;           // pixels of the first frequency that light returns to
  std::size_t empty = 0;         // pixels that see nothing
  std::size_t badly_empty = 0;   // of these, those with any light, or a phase, distance, range or depth
  std::size_t disagreements = 0; // where NaN, coverage, lit or an id is not the same
};

FrameDifference difference(const Measurement &measured, const Measurement &expected, const Sensor &sensor);

} // namespace pmdsim::test
