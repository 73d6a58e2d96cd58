#pragma once
// What a camera's taps make of one path of light: its part in z, by the phase that it comes with.

#include "engine/model/sensor.h"

#include <complex>
#include <utility>
#include <vector>

namespace pmdsim {

// (2/N) sum over k of C(phase - 2 pi k / N) exp(+j 2 pi k / N), C the correlation function (docs/theory.md,
// "The measurement"): a unit phasor for a sine, for other waves what the taps show of their harmonics.
class Demodulation {
public:
  Demodulation(const Waveform &waveform, std::uint32_t taps);

  struct Value {
    std::complex<double> of_unit;  // for light of weight 1
    std::complex<double> per_turn; // its slope; where square light has a corner, that behind it
  };
  Value at(double turns) const;
  bool is_sine() const { return is_sine_; }

private:
  Value of_square(double turns) const;

  bool is_sine_;
  std::uint32_t square_taps_ = 0;                      // square light only
  std::vector<std::pair<double, double>> harmonics_{}; // else: times the phase, and its amplitude
};

} // namespace pmdsim
