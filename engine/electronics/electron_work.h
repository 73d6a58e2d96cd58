#pragma once
// The data of the loops that count electrons, as plain arrays: they are compiled once for each instruction
// set, so they share no code with the rest of the program.

#include <cstdint>

namespace pmdsim {

constexpr std::uint32_t most_images = 16;

// The largest mean of which Poisson's numbers are found one by one.
constexpr float largest_counted_mean = 64.0f;
// At this read noise and above the steps of single electrons are gone: 3e-9 of them is left.
constexpr float least_merged_noise_e = 1.0f;
// Normal numbers are no farther from 0.
constexpr float largest_normal = 5.4f;

// The streams of random numbers of a pixel, which the counter's words tell apart.
enum class ChanceStream : std::uint32_t { normals, counts, reads, pattern };

// One frequency of a frame of one sensor. Pixels of all arrays are row by row.
struct ElectronWork {
  std::uint32_t images;              // N, most_images at most
  const float (*reference)[2];       // exp(j 2 pi k / N) of each
  const float (*twice_reference)[2]; // exp(j 4 pi k / N)
  // The noiseless correlation samples: of a sine by amplitude and phase, else by the taps.
  bool is_sine;
  const float *amplitude, *phase_rad;
  const float *const *taps;
  const float *const *mean_radiance; // of each image
  // Of a sine as a strip of the device has it (else nullptr): pairs of amplitude and phase, or of the
  // return's real and imaginary part, and of mean radiance and nothing, from pixel first_of_pairs on. Then
  // the mean radiance goes to mean_radiance_out.
  bool complex_returns;
  const float *return_pairs, *mean_pairs;
  std::uint32_t first_of_pairs;
  float *mean_radiance_out;
  const float *background; // of each pixel, relative to that of all; nullptr: all alike
  float all_background_e;  // of a tap
  // Electrons of each tap: half of what the mean light makes of a radiance, what its correlation sample adds
  // to tap A and takes from B, and in the dark.
  float half_per_radiance, part_per_correlation, dark_e;
  float read_noise_e, full_well_e, sbi_e, dsnu_e, prnu;
  float gain_dn_per_e, offset_dn, largest_dn;
  // Of a tap whose mean light is between these no electrons are counted one by one, and no reading is beyond
  // the camera's ends.
  float clear_from_e, clear_to_e;
  float reading_variance_e2; // of the reading of one tap
  float radiance_per_dn;     // of the difference that the camera takes for a correlation sample
  bool two_tap;
  std::uint32_t exposures; // that are averaged, of all parts of a pixel in turn
  std::uint32_t parts;     // each has a fixed pattern of its own
  // Of Philox's counter: key, frame, the word of sensor and exposure without the latter, and that of the
  // frequency.
  std::uint32_t key[2], frame, sensor, frequency;
  float of_image, per_exposure; // 2 / N, 1 / exposures
  // distance_noise_m over sqrt(sum_k variance_k sin^2) / amplitude, confidence over (N/2 |z| in digital
  // numbers) / sqrt(sum_k variance_k).
  float noise_scale, confidence_scale;
  float ambiguity_m;
  float below_turn, below_m; // the largest floats below 2 pi and below the ambiguity
  // Out: what the camera makes of it, and of its noise. Arrays of taps' pointers are nullptr where not kept.
  float *amplitude_out, *phase_rad_out, *distance_m_out, *distance_noise_m, *confidence;
  std::uint32_t *saturated;
  float *const *taps_out;
  float *const *tap_e[2];  // of A and B
  float *const *tap_dn[2]; // likewise
};

// One for each instruction set.
struct ElectronLoops {
  // The pixels from `first` to `last` - 1. Returns whether none has more light than a float can hold.
  bool (*count)(const ElectronWork &of, std::uint32_t first, std::uint32_t last);
};

} // namespace pmdsim
