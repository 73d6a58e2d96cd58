#pragma once
// From a pixel's sums to its channels.

#include "engine/reference/bounce/indirect_return.h"
#include "engine/reference/light/return_sum.h"
#include "engine/reference/reference.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim::reference {

// Sums over the samples of one pixel that hit something.
struct PixelSums {
  explicit PixelSums(const Sensor &sensor);

  std::vector<ReturnSum> returns; // beside Sensor::modulation_hz
  CompensatedSum range_m, z_m;    // distance to the lens, depth along the optical axis
  std::uint32_t hits = 0;
  std::size_t reached = 0; // diodes that reach each of them, added up
};

// A frame of pixels that see nothing.
Frame dark_frame(const Sensor &sensor, const Bounces &bounces = {});

// Fills every channel but the ids. `samples` is N_p, hit or not; `indirect` what bounces, empty without.
void set_channels(Frame &frame, std::size_t pixel, const PixelSums &sums, std::uint32_t samples,
                  const std::vector<IndirectReturn> &indirect = {});

} // namespace pmdsim::reference
