#include "engine/light/tones.h"

#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <numbers>

namespace pmdsim {
namespace {

double wavenumber_rad_m(double frequency_hz) {
  return 2.0 * std::numbers::pi * frequency_hz / speed_of_light_m_s;
}

} // namespace

double Modulation::largest_wavenumber_rad_m() const {
  return wavenumber_rad_m(tones * *std::max_element(modulation_hz.begin(), modulation_hz.end()));
}

std::vector<shader::Tone> Modulation::all_tones() const {
  std::vector<shader::Tone> result;
  for (const double frequency_hz : modulation_hz)
    for (std::uint32_t h = 1; h <= tones; ++h)
      result.push_back({float_pair(h * frequency_hz / speed_of_light_m_s),
                        static_cast<float>(wavenumber_rad_m(h * frequency_hz)), static_cast<float>(h)});
  result.resize(std::size_t{tones} * frequencies(), shader::Tone{});
  return result;
}

Modulation modulation_of(const Sensor &sensor, const SimulatorOptions &options) {
  Modulation modulation{shader::waveform_sine, sensor.taps,          1,     1, 1,
                        options.keep_taps,     sensor.modulation_hz, {1.0f}};
  modulation.keeps_mean = sensor.electronics.has_value();
  switch (sensor.waveform.kind) {
  case Waveform::Kind::sine:
    break;
  case Waveform::Kind::square:
    modulation.waveform = shader::waveform_square;
    modulation.distinct_taps = sensor.taps % 2 == 0 ? sensor.taps / 2 : sensor.taps;
    modulation.planes = (modulation.distinct_taps + 1) / 2;
    break;
  case Waveform::Kind::harmonics: // a harmonic is a tone like any other
    modulation.waveform = shader::waveform_harmonics;
    modulation.harmonics.assign(sensor.waveform.harmonics.begin(), sensor.waveform.harmonics.end());
    modulation.planes = modulation.tones = static_cast<std::uint32_t>(modulation.harmonics.size());
    break;
  }
  return modulation;
}

} // namespace pmdsim
