#pragma once
// The tones for which light that bounces is solved: each frequency of a sensor, and the harmonics of its
// waveform.

#include "engine/model/sensor.h"

#include <vector>

namespace pmdsim {

struct BounceTone {
  double hz;              // h times the modulation frequency
  std::uint32_t harmonic; // h
  std::size_t frequency;  // the index of that
  double relative;        // a_h of the correlation function
  double turns_per_m() const { return hz / speed_of_light_m_s; }

  bool operator==(const BounceTone &) const = default;
};

struct BounceTones {
  std::vector<BounceTone> tones;
  // The sum of the a_h that are left out, of each frequency: a bound of what they add, as a part of what
  // bounced light would be if it had no phase.
  double rest = 0.0;

  bool operator==(const BounceTones &) const = default;
};

BounceTones bounce_tones(const Sensor &sensor);

} // namespace pmdsim
