#include "engine/multipath/bounced_channels.h"

#include "engine/model/tap_sequence.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

using Number = std::complex<double>;

constexpr double full_turn_rad = 2.0 * std::numbers::pi;
// Half of a variance lies across z, where it shows in the distance: two standard deviations of that half.
constexpr double deviations = std::numbers::sqrt2;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// What a harmonic adds to the z that a camera forms of N taps, for the sum Z of its paths' phasors: a_h Z, or
// its conjugate, as docs/theory.md says ("Tones, harmonics and taps").
Number shown(const BounceTone &tone, std::uint32_t taps, const Number &z) {
  if (tone.harmonic % taps == 1)
    return tone.relative * z;
  return tone.harmonic % taps == taps - 1 ? tone.relative * std::conj(z) : 0.0;
}

// In [0, period), of less than a period away.
double within(double value, double period) {
  const double wrapped = value < 0.0 ? value + period : value >= period ? value - period : value;
  return wrapped < period ? wrapped : 0.0;
}

// One frequency's pixels.
class FrequencyChannels {
public:
  FrequencyChannels(const BouncedImage &image, const BounceTones &tones, const Sensor &sensor,
                    std::size_t frequency, Return &to)
      : image_(image), tones_(tones), taps_(sensor.taps), frequency_(frequency),
        ambiguity_m_(sensor.ambiguity_m(frequency)), to_(to) {
    to_.direct_amplitude = to_.amplitude;
    to_.direct_phase_rad = to_.phase_rad;
    to_.direct_distance_m = to_.distance_m;
    to_.unrounded_direct_distance_m = to_.unrounded_distance_m;
    for (auto *channel : {&to_.multipath_m, &to_.multipath_error_m, &to_.indirect_share})
      channel->assign(to_.amplitude.size(), not_a_number);
  }

  void add_to(std::size_t pixel) {
    Number indirect = 0.0;
    double variance = 0.0, rest = 0.0;
    for_each_tone([&](const BounceTone &tone, const BouncedTone &bounced) {
      const Number z(bounced.z[pixel]);
      const double relative = std::abs(tone.relative);
      if (shown(tone, taps_, 1.0) != 0.0) {
        const double deviation = relative * static_cast<double>(bounced.deviation[pixel]);
        variance += deviation * deviation;
      }
      indirect += shown(tone, taps_, z);
      rest = tones_.rest * std::abs(z);
      for (std::size_t k = 0; k < to_.taps.size(); ++k) {
        const double back = static_cast<double>(tone.harmonic) * static_cast<double>(k) / taps_;
        const Number tap = tone.relative * z * std::polar(1.0, -full_turn_rad * (back - std::floor(back)));
        to_.taps[k][pixel] += static_cast<float>(tap.real());
      }
    });
    const auto direct_amplitude = static_cast<double>(to_.direct_amplitude[pixel]);
    const bool is_lit = direct_amplitude > 0.0;
    const Number direct =
        is_lit ? std::polar(direct_amplitude, static_cast<double>(to_.direct_phase_rad[pixel])) : 0.0;
    set(pixel, direct, indirect, deviations * std::sqrt(variance) + rest);
  }

private:
  template <class Visit>
  void for_each_tone(const Visit &visit) const {
    for (std::size_t t = 0; t < tones_.tones.size(); ++t)
      if (tones_.tones[t].frequency == frequency_)
        visit(tones_.tones[t], image_.tones[t]);
  }

  void set(std::size_t pixel, const Number &direct, const Number &indirect, double error) {
    const Number z = direct + indirect;
    const double size = std::abs(z);
    if (!(size > 0.0)) {
      to_.amplitude[pixel] = 0.0f;
      to_.phase_rad[pixel] = to_.distance_m[pixel] = not_a_number;
      if (!to_.unrounded_distance_m.empty())
        to_.unrounded_distance_m[pixel] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const double turns_per_rad = 1.0 / full_turn_rad;
    const double multipath_m = ambiguity_m_ * std::arg(z * std::conj(direct)) * turns_per_rad;
    if (indirect != 0.0) { // else direct light's keep their bits
      set_return(to_, pixel, z, ambiguity_m_);
      if (direct != 0.0 && !to_.unrounded_distance_m.empty()) // whose phase was rounded
        to_.unrounded_distance_m[pixel] =
            within(to_.unrounded_direct_distance_m[pixel] + multipath_m, ambiguity_m_);
    }
    to_.indirect_share[pixel] = static_cast<float>(std::abs(indirect) / size);
    const double off_rad = error < size ? std::asin(error / size) : std::numbers::pi;
    to_.multipath_error_m[pixel] = static_cast<float>(ambiguity_m_ * off_rad * turns_per_rad);
    if (direct != 0.0)
      to_.multipath_m[pixel] = static_cast<float>(multipath_m);
  }

  const BouncedImage &image_;
  const BounceTones &tones_;
  std::uint32_t taps_;
  std::size_t frequency_;
  double ambiguity_m_;
  Return &to_;
};

} // namespace

std::vector<std::vector<Phasor>> direct_light(const Measurement &measurement,
                                              const std::vector<BounceTone> &tones) {
  std::vector<std::vector<Phasor>> light;
  for (const BounceTone &tone : tones) {
    std::vector<Phasor> of_tone(measurement.coverage.size());
    if (tone.is_mean()) {
      std::ranges::transform(measurement.mean_radiance, of_tone.begin(),
                             [](float mean) { return mean * unit_phasor(0.0); });
      light.push_back(std::move(of_tone));
      continue;
    }
    const Return &direct = measurement.returns[tone.frequency];
    for (std::size_t i = 0; i < of_tone.size(); ++i)
      if (direct.amplitude[i] > 0.0f)
        of_tone[i] =
            direct.amplitude[i] * unit_phasor(static_cast<double>(direct.phase_rad[i]) / full_turn_rad);
    light.push_back(std::move(of_tone));
  }
  return light;
}

void add_bounced(const BouncedImage &image, const BounceTones &tones, const Sensor &sensor,
                 Measurement &measurement) {
  for (std::size_t t = 0; t < tones.tones.size(); ++t)
    if (tones.tones[t].is_mean())
      for (std::size_t pixel = 0; pixel < measurement.mean_radiance.size(); ++pixel)
        measurement.mean_radiance[pixel] += std::max(image.tones[t].z[pixel].real(), 0.0f);
  for (std::size_t i = 0; i < measurement.returns.size(); ++i) {
    FrequencyChannels channels(image, tones, sensor, i, measurement.returns[i]);
    tbb::parallel_for(std::size_t{0}, sensor.pixel_count(),
                      [&](std::size_t pixel) { channels.add_to(pixel); });
  }
}

double quantile(const std::vector<float> &values, double part) {
  std::vector<float> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](float value) { return !std::isnan(value); });
  if (known.empty())
    return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(known.size() - 1));
  std::ranges::nth_element(known, known.begin() + at);
  return static_cast<double>(known[static_cast<std::size_t>(at)]);
}

} // namespace pmdsim
