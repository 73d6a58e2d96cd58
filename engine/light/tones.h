#pragma once
// How a sensor's modulation is summed: the planes of the sum (shaders/shared/interface.h). The channels that
// come of them are laid out in engine/signal/channel_layout.h.

#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"
#include "shaders/shared/interface.h"

#include <vector>

namespace pmdsim {

struct Modulation {
  std::uint32_t waveform;            // shader::waveform_*
  std::uint32_t taps;                // N
  std::uint32_t distinct_taps;       // that are summed where the waveform is square, else 1
  std::uint32_t planes;              // of the sum, of each frequency
  std::uint32_t tones;               // of each frequency, all multiples of it: the harmonics, else 1
  bool keep_taps;                    // the taps are channels, too
  std::vector<double> modulation_hz; // the frequencies
  std::vector<float> harmonics;      // amplitudes, one for each tone of a frequency
  bool keeps_terms = false;          // an error was asked for: the sum of the terms' sizes is kept
  bool keeps_beams = false;          // and what rounding does within beams (ErrorBound::beams)
  bool reports_kept = false;         // and the largest bound of the pixels that keep theirs
  bool keeps_bounds = false;         // each pixel's bound is a channel, too
  bool keeps_rests = false;          // what rounding takes from distance and range is a channel, too
  bool lit = false;                  // how much of the light reaches a pixel is a channel, too
  // Returns are there as real and imaginary part, in place of amplitude and phase and without a distance: for
  // a camera that makes its own of them.
  bool complex_returns = false;
  bool keeps_mean = false; // the mean radiance is a channel, too: the last frequency, 0 Hz

  // Those that are summed, the last one 0 Hz where the mean is kept.
  std::uint32_t frequencies() const { return modulations() + (keeps_mean ? 1 : 0); }
  std::uint32_t modulations() const { return static_cast<std::uint32_t>(modulation_hz.size()); }
  // One dispatch sums all tones of all frequencies by moments; else one each.
  bool by_moments() const { return waveform != shader::waveform_square; }
  std::uint32_t sum_planes() const { return planes * frequencies(); }
  // 2 pi f / c of the highest tone, rad/m.
  double largest_wavenumber_rad_m() const;
  // Frequency by frequency, the harmonics of each in order. Those of 0 Hz have no phase: their sum is that of
  // the weights.
  std::vector<shader::Tone> all_tones() const;
};

Modulation modulation_of(const Sensor &sensor, const SimulatorOptions &options);

} // namespace pmdsim
