#include "engine/electronics/other_light.h"

#include "engine/model/tap_sequence.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double whole_turn_rad = 2.0 * std::numbers::pi;

// E8's factor of the other light's complex return: what an image's exposure leaves of the beat, at the phase
// that the beat has in its middle.
std::complex<double> beat(double apart_hz, double begin_s, double integration_time_s) {
  const double turns = std::fmod(apart_hz * (begin_s + 0.5 * integration_time_s), 1.0);
  const double half_rad = 0.5 * whole_turn_rad * apart_hz * integration_time_s;
  const double left = half_rad == 0.0 ? 1.0 : std::sin(half_rad) / half_rad;
  return std::polar(1.0, -whole_turn_rad * turns) * left;
}

std::vector<std::vector<float>> taps_of_sine(const Sensor &sensor, const Return &of) {
  std::vector<std::vector<float>> taps(sensor.taps);
  for (std::size_t k = 0; k < taps.size(); ++k) {
    const double reference_rad = whole_turn_rad * static_cast<double>(k) / sensor.taps;
    for (std::size_t pixel = 0; pixel < of.amplitude.size(); ++pixel) {
      const double amplitude = of.amplitude[pixel];
      taps[k].push_back(amplitude > 0.0
                            ? static_cast<float>(amplitude * std::cos(of.phase_rad[pixel] - reference_rad))
                            : 0.0f);
    }
  }
  return taps;
}

} // namespace

void add_beat(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
              const OtherLight &other, std::vector<float> &correlation) {
  const std::complex<double> factor =
      beat(other.modulation_hz - sensor.modulation_hz[frequency], begin_s,
           sensor.electronics->integration_time_s) *
      std::polar(1.0, -whole_turn_rad * static_cast<double>(tap) / sensor.taps);
  const Return &seen = other.seen.returns.front();
  for (std::size_t pixel = 0; pixel < correlation.size(); ++pixel)
    if (const double amplitude = seen.amplitude[pixel]; amplitude > 0.0) {
      const double phase_rad = seen.phase_rad[pixel];
      correlation[pixel] += static_cast<float>(
          amplitude * (std::cos(phase_rad) * factor.real() - std::sin(phase_rad) * factor.imag()));
    }
}

void add_other_light(const Sensor &sensor, double frame_s, const OtherLight &other, Measurement &frame) {
  add_mean(other, frame.mean_radiance);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    Return &of = frame.returns[i];
    std::vector<std::vector<float>> taps = of.taps.empty() ? taps_of_sine(sensor, of) : std::move(of.taps);
    for (std::size_t k = 0; k < taps.size(); ++k)
      add_beat(sensor, i, k, tap_time_s(sensor, frame_s, i, k), other, taps[k]);
    set_from_taps(of, std::move(taps), sensor.modulation_hz[i]);
  }
}

void add_mean(const OtherLight &other, std::vector<float> &mean_radiance) {
  for (std::size_t pixel = 0; pixel < mean_radiance.size(); ++pixel)
    mean_radiance[pixel] += other.seen.mean_radiance[pixel];
}

} // namespace pmdsim
