#pragma once
// From a pixel's sums to its channels.

#include "engine/reference/compensated_sum.h"
#include "engine/reference/reference.h"

#include <cstddef>
#include <cstdint>

namespace pmdsim::reference {

// Sums over the samples of one pixel that hit something.
struct PixelSums {
  ComplexSum z;                // eq. 5's double sum, before 1/N_p
  CompensatedSum range_m, z_m; // distance to the lens, depth along the optical axis
  std::uint32_t hits = 0;
};

// A frame of pixels that see nothing.
Frame dark_frame(const Sensor &sensor);

// Fills every channel but the ids. `samples` is N_p, hit or not.
void set_channels(Frame &frame, std::size_t pixel, const PixelSums &sums, std::uint32_t samples);

} // namespace pmdsim::reference
