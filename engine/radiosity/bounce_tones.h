#pragma once
// The tones for which light that bounces is solved: each frequency of a sensor, and the harmonics of its
// waveform; and 0 Hz, the mean light, where the sensor has electronics.

#include "engine/model/sensor.h"

#include <vector>

namespace pmdsim {

struct BounceTone {
  double hz;              // h times the modulation frequency
  std::uint32_t harmonic; // h; 0 of the mean light
  std::size_t frequency;  // the index of that; of the mean light one more than the last
  double relative;        // a_h of the correlation function
  double turns_per_m() const { return hz / speed_of_light_m_s; }
  bool is_mean() const { return harmonic == 0; }

  bool operator==(const BounceTone &) const = default;
};

struct BounceTones {
  std::vector<BounceTone> tones;
  // Twice the root of the sum of a_h^2 over the harmonics h that are left out, of each frequency: what they
  // add, as a part of what the last one that is not brings before it is weighted, taken to have any phase.
  double rest = 0.0;

  bool operator==(const BounceTones &) const = default;
};

BounceTones bounce_tones(const Sensor &sensor);

} // namespace pmdsim
