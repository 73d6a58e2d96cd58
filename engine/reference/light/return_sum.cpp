#include "engine/reference/light/return_sum.h"

namespace pmdsim::reference {

namespace {

// Whole turns are taken off before anything multiplies, so a long path costs no more than its own rounding.
double fraction(double turns) { return turns - std::floor(turns); }

double triangle_wave(double turns) { return std::abs(4.0 * fraction(turns) - 2.0) - 1.0; }

double harmonic_sum(const std::vector<double> &amplitudes, double turns) {
  const double phase_rad = full_turn_rad * fraction(turns);
  double sum = 0.0, harmonic = 1.0;
  for (const double amplitude : amplitudes) {
    sum += amplitude * std::cos(harmonic * phase_rad);
    harmonic += 1.0;
  }
  return sum;
}

// N taps show a harmonic h as its difference from the multiples of N next to it: as the fundamental, where
// that is 1. Where none shows as one, rounding must not leave a phase.
bool shows_a_fundamental(const Waveform &waveform, std::uint32_t taps) {
  if (waveform.kind != Waveform::Kind::harmonics)
    return true;
  for (std::size_t h = 1; h <= waveform.harmonics.size(); ++h)
    if (waveform.harmonics[h - 1] != 0.0 && (h % taps == 1 || h % taps == taps - 1))
      return true;
  return false;
}

double reference_turns(std::uint32_t tap, std::uint32_t taps) { return static_cast<double>(tap) / taps; }

} // namespace

double correlation(const Waveform &waveform, double turns) {
  switch (waveform.kind) {
  case Waveform::Kind::square:
    return triangle_wave(turns);
  case Waveform::Kind::harmonics:
    return harmonic_sum(waveform.harmonics, turns);
  case Waveform::Kind::sine:
    break;
  }
  return std::cos(full_turn_rad * fraction(turns));
}

ReturnSum::ReturnSum(const Sensor &sensor, double modulation_hz)
    : sensor_(&sensor), turns_per_m_(modulation_hz / speed_of_light_m_s), taps_(is_sine() ? 0 : sensor.taps) {
}

void ReturnSum::add(const std::vector<LightPath> &paths) {
  for (const LightPath &path : paths) {
    weight_.add(path.weight_w_m2_sr);
    mean_radiance_.add(path.weight_w_m2_sr / path.modulation_depth);
  }
  if (is_sine())
    for (const LightPath &path : paths)
      phasors_.add(std::polar(path.weight_w_m2_sr, full_turn_rad * phase_turns(path)));
  for (std::uint32_t k = 0; k < taps_.size(); ++k)
    for (const LightPath &path : paths) {
      const double turns = phase_turns(path) - reference_turns(k, sensor_->taps);
      taps_[k].add(path.weight_w_m2_sr * correlation(sensor_->waveform, turns));
    }
}

double ReturnSum::phase_turns(const LightPath &path) const {
  return fraction(path.length_m * turns_per_m_) + path.phase_turns;
}

MeanReturn ReturnSum::mean(std::uint32_t samples) const {
  MeanReturn mean{
      z() / static_cast<double>(samples), {}, weight_.value() / samples, mean_radiance_.value() / samples};
  mean.taps.reserve(sensor_->taps);
  for (std::uint32_t k = 0; k < sensor_->taps; ++k)
    mean.taps.push_back(tap(k) / samples);
  return mean;
}

std::complex<double> ReturnSum::z() const {
  if (is_sine())
    return phasors_.value();
  if (!shows_a_fundamental(sensor_->waveform, sensor_->taps))
    return 0.0;
  ComplexSum sum;
  for (std::uint32_t k = 0; k < taps_.size(); ++k)
    sum.add(taps_[k].value() * std::polar(1.0, full_turn_rad * reference_turns(k, sensor_->taps)));
  return 2.0 / sensor_->taps * sum.value();
}

double ReturnSum::tap(std::uint32_t k) const {
  if (!is_sine())
    return taps_[k].value();
  const std::complex<double> sum = phasors_.value();
  if (sum == 0.0)
    return 0.0; // which the product could make -0
  return std::real(sum * std::polar(1.0, -full_turn_rad * reference_turns(k, sensor_->taps)));
}

} // namespace pmdsim::reference
