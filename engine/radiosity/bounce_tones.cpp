#include "engine/radiosity/bounce_tones.h"

#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

constexpr std::size_t square_tones = 8; // harmonics 1, 3, ..., 15

struct Harmonic {
  std::uint32_t number;
  double relative;
};

// Square light on a square reference correlates to the triangle wave, sum over odd h of 8 / (pi h)^2 cos(h
// x).
double of_triangle_wave(std::uint32_t harmonic) {
  return 8.0 / (std::numbers::pi * std::numbers::pi * harmonic * harmonic);
}

std::vector<Harmonic> harmonics_of(const Waveform &waveform) {
  std::vector<Harmonic> harmonics;
  switch (waveform.kind) {
  case Waveform::Kind::sine:
    harmonics.push_back({1, 1.0});
    break;
  case Waveform::Kind::square:
    for (std::uint32_t i = 0; i < square_tones; ++i)
      harmonics.push_back({2 * i + 1, of_triangle_wave(2 * i + 1)});
    break;
  case Waveform::Kind::harmonics:
    for (std::uint32_t i = 0; i < waveform.harmonics.size(); ++i)
      if (waveform.harmonics[i] != 0.0)
        harmonics.push_back({i + 1, waveform.harmonics[i]});
    break;
  }
  return harmonics;
}

} // namespace

BounceTones bounce_tones(const Sensor &sensor) {
  BounceTones made;
  const std::vector<Harmonic> harmonics = harmonics_of(sensor.waveform);
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    for (const Harmonic &harmonic : harmonics)
      made.tones.push_back(
          {harmonic.number * sensor.modulation_hz[i], harmonic.number, i, harmonic.relative});
  if (sensor.electronics)
    made.tones.push_back({0.0, 0, sensor.modulation_hz.size(), 1.0});
  if (sensor.waveform.kind == Waveform::Kind::square) {
    double left_out = 2.0 / 3.0; // the sum of a_h^2 over all odd h
    for (const Harmonic &harmonic : harmonics)
      left_out -= harmonic.relative * harmonic.relative;
    made.rest = 2.0 * std::sqrt(left_out);
  }
  return made;
}

} // namespace pmdsim
