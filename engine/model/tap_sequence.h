#pragma once
// A frame whose correlation samples are taken one after the other: when, and what the camera makes of them.

#include "engine/model/measurement.h"
#include "engine/model/sensor.h"

#include <complex>
#include <cstddef>
#include <vector>

namespace pmdsim {

// When the tap of a frequency is taken, of a frame that begins at `frame_s`.
inline double tap_time_s(const Sensor &sensor, double frame_s, std::size_t frequency, std::size_t tap) {
  return frame_s + static_cast<double>(frequency * sensor.taps + tap) * sensor.tap_interval_s;
}

// From the first tap's exposure to the end of the last one's.
inline double tap_sequence_s(const Sensor &sensor) {
  return static_cast<double>(sensor.modulation_hz.size() * sensor.taps) * sensor.tap_interval_s;
}

// Sets a pixel's amplitude, phase and distance to those of z, which is not 0; `ambiguity_m` is c / (2 f). The
// unrounded distance, too, where there is room for it.
void set_return(Return &to, std::size_t pixel, const std::complex<double> &z, double ambiguity_m);

// A sine's correlation samples A cos(phi - theta) at the reference phase theta; 0 where A is 0 or NaN.
std::vector<float> tap_of_sine(const std::vector<float> &amplitude, const std::vector<float> &phase_rad,
                               double reference_rad);

// The camera's demodulation of a frequency's N taps, in double: z = (2/N) sum_k c_k exp(+j 2 pi k / N), and
// the channels from z. The taps, one of each k and of one length, stay beside them. A |z| below what rounding
// the taps to float can make counts as 0. `keep_unrounded`: with the unrounded distance.
Return return_from_taps(std::vector<std::vector<float>> taps, double modulation_hz,
                        bool keep_unrounded = false);

// Sets taps, amplitude, phase and distance to those, the unrounded distance where there is one, and leaves
// the other channels.
void set_from_taps(Return &to, std::vector<std::vector<float>> taps, double modulation_hz);

} // namespace pmdsim
