#pragma once
// The data of the host's way from depth records to channels, as plain arrays: its loops are compiled once for
// each instruction set, so they share no code with the rest of the program.

#include "engine/light/host/law_sums.h"
#include "engine/light/host/run_form.h"

#include <cstdint>

namespace pmdsim {

constexpr std::uint32_t most_pixel_frequencies = 8;

// What shaders/frame/direct_pixels.comp does, for any number of runs of sources.
struct PixelWork {
  LawSums sums;         // the samples, and the sources where they are not summed beforehand
  const RunForm *forms; // of each run
  const shader::Tone *tones;
  const shader::Frequency *frequencies; // beside the tones
  std::uint32_t frequency_count;        // that have phases, most_pixel_frequencies at most
  const shader::Frequency *mean;        // of the mean light; nullptr where it is no channel
  const float *backscatter;             // of all that is seen; nullptr: looked up
  bool vignetting;
  const std::uint32_t *lit; // sources that reach a sample; nullptr where they are no channel
  float *channels;          // pair by pair (shaders/shared/interface.h)
  std::uint32_t plane;      // pixels of a channel, padding included
  bool holds;               // an error was asked for
  // The list of pixels that may be beyond it and its length, which threads share; nullptr: they are counted.
  std::uint32_t *later, *later_count;
  bool keeps_bounds, keeps_rests;
  // Of each frequency's channels, the pairs in which taps, bounds and rests begin.
  std::uint32_t first_tap, bound, rests;
  bool complex_returns;          // Modulation::complex_returns; then no taps are kept, and nothing is held
  std::uint32_t kept_taps;       // 0: none are
  const float (*tap_phasors)[2]; // exp(j 2 pi k / N)
  // Where the field is interpolated: its cells over a row of the strip, and in place of the forms and the
  // frequencies those of the pixels that it does for.
  std::uint32_t cells_across;
  const RunForm *field_forms;
  const shader::Frequency *field_frequencies;
};

// What the returns of some pixels may be off by, as distance and as relative amplitude: the worst of those
// within what was asked for, and of the others, where these are counted.
struct PixelClaims {
  float kept_m, kept_amplitude;
  std::uint32_t returns_beyond;
  float worst_m, worst_amplitude;
};

// Makes the channels of some rows, of some of the field's cells, row by row of these, or of listed blocks,
// the last one excluded. One for each instruction set.
struct PixelLoops {
  PixelClaims (*of_rows)(const PixelWork &of, std::uint32_t first, std::uint32_t last);
  PixelClaims (*of_cells)(const PixelWork &of, std::uint32_t first, std::uint32_t last);
  PixelClaims (*of_blocks)(const PixelWork &of, std::uint32_t first, std::uint32_t last);
};

} // namespace pmdsim
