#pragma once
// The camera's electronics: from a noiseless frame to the frame that the camera would make of its electrons.
// By the host on any device: the same light gives the same bits.

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace pmdsim {

struct ElectronsRequest {
  // The mean radiance at the exposure of each tap, frequency by frequency, where they are exposed one by one;
  // empty: Measurement::mean_radiance.
  std::vector<std::vector<float>> mean_radiance_of_taps{};
  bool reads_taps = false;              // Return::taps are read of a sine, too, as they are no samples of one
  bool keep_taps = false;               // fill Return::taps, tap_a_e and the like
  std::uint32_t host_vector_bits = 512; // at most; any gives the same bits
  std::function<void()> between = {};   // called now and then; may throw to stop
};

// `frame` is a noiseless frame of a sensor with electronics, with its number and mean radiance; its taps are
// read where they are there, and have to be unless the waveform is a sine. All chance follows from
// Electronics::seed, the frame's and the sensor's number, frequency, tap and pixel (Philox4x32-10). Adds the
// pass "electrons" to the frame's times.
void count_electrons(const Sensor &sensor, const ElectronsRequest &request, Measurement &frame);

// The noiseless light of a strip of a frame, row by row as a device leaves it: of a sine.
struct StripLight {
  std::uint32_t column, row, columns, rows; // its place in the frame
  bool is_complex;                          // returns are real and imaginary part, else amplitude and phase
  std::vector<const float *> returns;       // two values a pixel, of each frequency
  const float *mean_radiance;               // two values a pixel, of which the first counts
};

// Whether a sensor's electrons can be counted strip by strip: of a sine, at most 64 readings that are
// averaged, and neither scatter nor noiseless channels.
bool counts_by_strips(const Sensor &sensor);

// The same of a strip's pixels: their channels in `frame`, which has room for all, and no others' are
// written. Of the request `keep_taps` and `host_vector_bits` count.
void count_electrons(const Sensor &sensor, const ElectronsRequest &request, const StripLight &light,
                     Measurement &frame);

} // namespace pmdsim
