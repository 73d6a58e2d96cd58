#pragma once
// A device against the reference on some pixels of a frame.

#include "host/bench/accuracy_check.h"
#include "host/bench/timing.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim {

inline constexpr double checked_share = 0.01; // of a frame's pixels
// Engines that decide by their own rounding may decide otherwise which diodes reach a point where the diodes,
// seen from there, are as close as this to a shadow's edge.
inline constexpr double rounding_of_diode_m = 10e-6, rounding_of_point_m = 1e-6;

struct PixelCheck {
  AccuracyCheck compared; // of these pixels, as a frame of one column
  // Pairs apart that the reference decides alike with the diodes and the points moved a little to each side.
  std::size_t pairs_beyond_rounding = 0;
};

// A frame of the setup's first sensor, one sample a pixel, with its sample triangles and, where shadows are
// automatic, with what reaches each sample, at these pixels and its first frequency. Throws Error.
PixelCheck check_pixels(const Setup &setup, const Measurement &frame,
                        const std::vector<std::uint32_t> &pixels);

// Measures such a frame and checks random pixels of it, the same ones every time. Throws Error.
PixelCheck check_some_pixels(const Setup &setup, const BenchRequest &request);

} // namespace pmdsim
