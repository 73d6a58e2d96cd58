#pragma once
// The light of another camera, modulated at a frequency of its own (docs/theory.md, "Another camera"): its
// mean is background, and in a short exposure something of its beat is left. By the host on any device.

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <complex>
#include <cstddef>
#include <vector>

namespace pmdsim {

// What a sensor's pixels see of another camera's light alone, at that camera's frequency.
struct OtherLight {
  double modulation_hz;
  std::vector<std::complex<float>> returns; // 0 where none comes
  std::vector<float> mean_radiance;
};

// From a frame of it.
OtherLight other_light_of(double modulation_hz, const Measurement &seen);

// Adds its beat to the correlation samples of the sensor's image of a frequency and a tap, whose exposure
// begins at `begin_s`. The sensor has electronics.
void add_beat(const Sensor &sensor, std::size_t frequency, std::size_t tap, double begin_s,
              const OtherLight &other, std::vector<float> &correlation);
void add_mean(const OtherLight &other, std::vector<float> &mean_radiance);

// Adds it to a frame of one exposure that begins at `frame_s`: to its mean radiance, and to its taps, which
// it has afterwards, with the channels that follow from them.
void add_other_light(const Sensor &sensor, double frame_s, const OtherLight &other, Measurement &frame);

} // namespace pmdsim
