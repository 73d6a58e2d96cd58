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
  // Twice the root of the sum of a_h^2 over the harmonics h that are left out, of each frequency: what they
  // add, as a part of what the last one that is not brings before it is weighted, taken to have any phase.
  double rest = 0.0;

  bool operator==(const BounceTones &) const = default;
};

BounceTones bounce_tones(const Sensor &sensor);

} // namespace pmdsim
