#include "engine/electronics/other_light.h"

#include "engine/model/tap_sequence.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <tbb/parallel_for.h>
#include <utility>

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

std::vector<std::vector<float>> taps_of(const Sensor &sensor, Return &of) {
  if (!of.taps.empty())
    return std::move(of.taps);
  std::vector<std::vector<float>> taps;
  for (std::uint32_t k = 0; k < sensor.taps; ++k)
    taps.push_back(tap_of_sine(of.amplitude, of.phase_rad, whole_turn_rad * k / sensor.taps));
  return taps;
}

} // namespace

OtherLight other_light_of(double modulation_hz, const Measurement &seen) {
  const Return &of = seen.returns.front();
  OtherLight other{modulation_hz, std::vector<std::complex<float>>(of.amplitude.size()), seen.mean_radiance};
  tbb::parallel_for(std::size_t{0}, of.amplitude.size(), [&](std::size_t pixel) {
    if (of.amplitude[pixel] > 0.0f)
      other.returns[pixel] =
          std::complex<float>(std::polar<double>(of.amplitude[pixel], of.phase_rad[pixel]));
  });
  return other;
}

void add_beat(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
              const OtherLight &other, std::vector<float> &correlation) {
  const std::complex<float> factor(beat(other.modulation_hz - sensor.modulation_hz[frequency], begin_s,
                                        sensor.electronics->integration_time_s) *
                                   std::polar(1.0, -whole_turn_rad * static_cast<double>(tap) / sensor.taps));
  for (std::size_t pixel = 0; pixel < correlation.size(); ++pixel) {
    const std::complex<float> &z = other.returns[pixel];
    correlation[pixel] += z.real() * factor.real() - z.imag() * factor.imag();
  }
}

void add_mean(const OtherLight &other, std::vector<float> &mean_radiance) {
  for (std::size_t pixel = 0; pixel < mean_radiance.size(); ++pixel)
    mean_radiance[pixel] += other.mean_radiance[pixel];
}

void add_other_light(const Sensor &sensor, double frame_s, const OtherLight &other, Measurement &frame) {
  add_mean(other, frame.mean_radiance);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    std::vector<std::vector<float>> taps = taps_of(sensor, frame.returns[i]);
    for (std::size_t k = 0; k < taps.size(); ++k)
      add_beat(sensor, i, k, tap_time_s(sensor, frame_s, i, k), other, taps[k]);
    set_from_taps(frame.returns[i], std::move(taps), sensor.modulation_hz[i]);
  }
}

} // namespace pmdsim
