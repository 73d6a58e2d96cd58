#pragma once
// The camera's measurement of one frame. Every channel is row-major, row 0 at the top, rows * columns values.

#include "engine/model/accuracy.h"
#include "engine/model/device_info.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace pmdsim {

// The return at one modulation frequency f. Phase and amplitude are those of z, which the camera forms from
// its N taps c_k as (2/N) sum_k c_k exp(+j 2 pi k / N); for a sine that is eq. 5 to 7's mean return.
struct Return {
  std::vector<float> amplitude;  // |z|, W/(m^2 sr), 0 where nothing returns
  std::vector<float> phase_rad;  // arg z in [0, 2 pi), NaN where |z| = 0
  std::vector<float> distance_m; // c phase / (4 pi f) in [0, c/(2f)), NaN where |z| = 0
  // c_k, k = 0 ... N-1: the mean of the correlation function at path phase - 2 pi k / N, W/(m^2 sr), 0 where
  // nothing returns; empty unless the taps are asked for.
  std::vector<std::vector<float>> taps;
  // An upper bound of the error of distance_m, m, from theory: infinite where nothing can be said, NaN where
  // nothing returns. Empty unless some pixel may be off by more than was asked for.
  std::vector<float> error_bound_m{};
  // With bounces (engine/model/bounces.h), else empty. Amplitude, phase, distance and taps above include
  // them.
  std::vector<float> direct_amplitude{}, direct_phase_rad{}, direct_distance_m{}; // without them
  // distance_m - direct_distance_m, wrapped to (-c/(4f), c/(4f)]; NaN where either is.
  std::vector<float> multipath_m{};
  // How far multipath_m is off, estimated: at most so far in 95 % of the pixels; NaN where nothing returns.
  std::vector<float> multipath_error_m{};
  std::vector<float> indirect_share{}; // |indirect| / |z|; NaN where nothing returns
  // With electronics (engine/model/electronics.h), else empty. Amplitude, phase, distance and taps above are
  // what the camera makes of its digital numbers then. Of each image k, means of Electronics::frames_averaged
  // exposures; the taps' electrons and numbers only where the taps are asked for, tap B's only of two taps.
  // The simulator leaves them to engine/electronics/electrons.h: until then they may hold an earlier frame's.
  std::vector<std::vector<float>> tap_a_e{}, tap_b_e{};   // electrons before the ADC
  std::vector<std::vector<float>> tap_a_dn{}, tap_b_dn{}; // digital numbers
  // Bit k: tap A of image k was full, or beyond the ADC's range, in some exposure; bit 16 + k: tap B.
  std::vector<std::uint32_t> saturated{};
  double share_saturated = 0.0; // of the pixels: where that is not 0; stays where the channel is left out
  // The predicted standard deviation of distance_m; NaN where nothing returns or a tap's mean is full.
  std::vector<float> distance_noise_m{};
  std::vector<float> confidence{}; // amplitude over the predicted standard deviation of either part of z
  // With Electronics::noiseless_channels: the channels above without noise.
  std::vector<float> amplitude_noiseless{}, phase_rad_noiseless{}, distance_m_noiseless{};
  // With SimulatorOptions::keep_unrounded, else empty: the distances above in double, as they were before
  // they were rounded, and as exact as what they come from. So differences of distances keep their digits.
  std::vector<double> unrounded_distance_m{}, unrounded_direct_distance_m{}, unrounded_distance_m_noiseless{};
};

// Which exposure of a setup: what differs from one to the next, as noise does, follows from these numbers and
// from no clock.
struct ExposureNumber {
  std::uint32_t sensor = 0, frame = 0;
  std::uint32_t exposure = 0; // of the frame, whose taps may be exposed one by one, frequency by frequency

  bool operator==(const ExposureNumber &) const = default;
};

// What bounces took, and how far they are off.
struct BouncesReport {
  std::size_t elements = 0;   // of surfaces, for which what bounces was solved
  std::size_t lines = 0;      // along which places looked around, of the solution and of the frame
  std::uint32_t products = 0; // of the iterations, all tones together
  double claimed_m = 0.0; // multipath_error_m of the first frequency, which 95 % of its pixels do not exceed
};

struct Measurement {
  ExposureNumber number;       // as measure() was told
  glm::uvec2 resolution{0, 0}; // columns, rows

  std::vector<Return> returns; // beside Sensor::modulation_hz
  // Ground truth over the pixel's samples that hit something; NaN where none does.
  std::vector<float> range_m;  // mean distance point - lens
  std::vector<float> z_m;      // mean depth along the optical axis
  std::vector<float> coverage; // samples hit / samples, 0 to 1
  // The fraction of the diodes that reach the pixel, mean over its samples that hit something, 0 where none
  // does; empty with Shadows::off.
  std::vector<float> lit;
  // The mean radiance of all diodes' light, W/(m^2 sr), noiseless; empty unless Sensor::electronics.
  std::vector<float> mean_radiance;
  bool has_electrons = false; // the sensor's electronics have read the frame; else it is of the light alone
  // From all frequencies together, with Sensor::unwrap_range_m, else empty: the distance, NaN where some
  // frequency has none or all that fit lie beyond the range, and 1 where the phases agree on it and on no
  // other, else 0, as where a tap is full.
  std::vector<float> unwrapped_distance_m;
  std::vector<std::uint32_t> unwrap_ok;
  // As Return::unrounded_distance_m.
  std::vector<double> unrounded_range_m, unrounded_unwrapped_distance_m;
  // The ids at the sample nearest the pixel's centre (ties: up, left); no_id where it hits nothing.
  std::vector<std::uint32_t> triangle_id;
  std::vector<std::uint32_t> object_id;

  // Only on demand (engine/lens/view_channels.h), in the camera frame (x right, y down, z forward), unit
  // vectors: the geometric normal of that triangle or disc, turned to the lens, NaN where nothing is hit; and
  // the way from the lens through the pixel's centre, NaN where the lens has no ray there.
  std::vector<float> normal_x, normal_y, normal_z, ray_x, ray_y, ray_z;
  std::vector<double> unrounded_normal_x, unrounded_normal_y, unrounded_normal_z;
  std::vector<double> unrounded_ray_x, unrounded_ray_y, unrounded_ray_z;

  // The id at every sample, (S*rows) x (S*columns), row-major; only filled on request.
  std::vector<std::uint32_t> sample_triangle_id;
  // The sample's pixel ID: row * columns + column + 1, 0 where nothing is seen; not filled by the reference.
  std::vector<std::uint32_t> sample_pixel_id;
  // Which diodes reach it, Shadows::automatic only: ceil(diodes / 32) words a sample, diode m (counted
  // through all illuminators) in bit m % 32 of word m / 32.
  std::vector<std::uint32_t> sample_visibility;

  AccuracyReport accuracy;
  std::optional<BouncesReport> bounces; // nothing without
  double frame_ms = 0.0;                // first pass to results in host memory, by the clock
  std::vector<PassTime> passes;         // the same by pass
};

} // namespace pmdsim
