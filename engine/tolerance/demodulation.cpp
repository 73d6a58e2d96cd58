#include "engine/tolerance/demodulation.h"

#include "engine/tolerance/lit_view.h"

#include <cmath>

namespace pmdsim {
Demodulation::Demodulation(const Waveform &waveform, std::uint32_t taps)
    : is_sine_(waveform.kind == Waveform::Kind::sine) {
  if (is_sine_)
    harmonics_ = {{1.0, 1.0}};
  if (waveform.kind == Waveform::Kind::square)
    square_taps_ = taps;
  if (waveform.kind != Waveform::Kind::harmonics)
    return;
  // A harmonic shows as its difference from the multiple of N next to it, turning with it or against it.
  for (std::size_t h = 1; h <= waveform.harmonics.size(); ++h) {
    const double amplitude = waveform.harmonics[h - 1], times = static_cast<double>(h);
    if (h % taps == 1 && amplitude != 0.0)
      harmonics_.emplace_back(times, amplitude);
    if (h % taps == taps - 1 && amplitude != 0.0)
      harmonics_.emplace_back(-times, amplitude);
  }
}

Demodulation::Value Demodulation::at(double turns) const {
  if (square_taps_ > 0)
    return of_square(turns);
  Value sum{};
  const double fraction_rad = radians_per_turn * (turns - std::floor(turns));
  for (const auto &[times, amplitude] : harmonics_) {
    const std::complex<double> phasor = std::polar(amplitude, times * fraction_rad);
    sum.of_unit += phasor;
    sum.per_turn += std::complex(0.0, radians_per_turn * times) * phasor;
  }
  return sum;
}

// The triangle wave, tap by tap.
Demodulation::Value Demodulation::of_square(double turns) const {
  Value sum{};
  for (std::uint32_t k = 0; k < square_taps_; ++k) {
    const double reference = static_cast<double>(k) / square_taps_, phase = turns - reference;
    const double fraction = phase - std::floor(phase);
    const std::complex<double> unit = std::polar(2.0 / square_taps_, radians_per_turn * reference);
    sum.of_unit += (std::abs(4.0 * fraction - 2.0) - 1.0) * unit;
    sum.per_turn += (fraction < 0.5 ? -4.0 : 4.0) * unit;
  }
  return sum;
}

} // namespace pmdsim
