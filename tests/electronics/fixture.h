#pragma once
// Small frames of a sensor with electronics, from dark to full.

#include "engine/electronics/electrons.h"
#include "engine/electronics/photon_chain.h"
#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace pmdsim::test {

// A sensor of made-up electronics with round numbers, and a noiseless frame of it in which every pixel of a
// row sees the same, and row after row more light.
struct LightLevels {
  Sensor sensor;
  Measurement noiseless;
  std::vector<double> signal_e; // of each row, in both taps
};

inline Electronics plain_electronics() {
  Electronics of;
  of.integration_time_s = 1e-3;
  of.quantum_efficiency = 0.5;
  of.lens_f_number = 1.5;
  of.lens_transmission = 0.9;
  of.demodulation_contrast = {0.6};
  of.full_well_e = 50e3;
  of.read_noise_e = 25.0;
  of.dark_current_e_per_s = 8000.0;
  of.gain_dn_per_e = 0.08;
  of.adc_bits = 12;
  of.offset_dn = 40.0;
  of.background_radiance_w_m2_sr = 0.0;
  of.seed = 20261127;
  return of;
}

inline LightLevels light_levels(const Electronics &electronics, std::uint32_t images,
                                const std::vector<double> &signal_e, double phase_rad = 1.1,
                                std::uint32_t columns = 16) {
  LightLevels levels;
  levels.sensor.resolution = {columns, static_cast<std::uint32_t>(signal_e.size())};
  levels.sensor.pixel_pitch_m = {10e-6, 10e-6};
  levels.sensor.taps = images;
  levels.sensor.electronics = electronics;
  levels.signal_e = signal_e;
  levels.noiseless.resolution = levels.sensor.resolution;
  Return &of = levels.noiseless.returns.emplace_back();
  for (const double electrons : signal_e)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const auto radiance = static_cast<float>(electrons / electrons_of(1.0, levels.sensor));
      of.amplitude.push_back(radiance);
      of.phase_rad.push_back(static_cast<float>(phase_rad));
      of.distance_m.push_back(
          static_cast<float>(levels.sensor.ambiguity_m() * phase_rad / (2.0 * std::acos(-1.0))));
      levels.noiseless.mean_radiance.push_back(radiance);
    }
  return levels;
}

inline Measurement noisy_frame(const LightLevels &levels, std::uint32_t number,
                               const ElectronsRequest &request = {.keep_taps = true}) {
  Measurement frame = levels.noiseless;
  frame.number.frame = number;
  count_electrons(levels.sensor, request, frame);
  return frame;
}

// Of numbers that are added one by one.
class Moments {
public:
  void add(double value) {
    ++count_;
    const double off = value - mean_;
    mean_ += off / count_;
    squares_ += off * (value - mean_);
  }
  double count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const { return squares_ / (count_ - 1.0); }

private:
  double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;
};

} // namespace pmdsim::test
