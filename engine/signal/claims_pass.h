#pragma once
// The use of the errors that pixels of a frame of depth records may have: the frame's claim, and the pixels
// that a later class sums again.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Where those errors have been left: as ClaimsConstants::errors, in planes of samples or of pixels.
struct HeldErrors {
  const vulkan::Buffer &in;
  Resources resource;
  bool of_samples;

  std::uint32_t plane(const shader::Strip &strip) const {
    return of_samples ? sample_count(strip) : strip.padded_pixels;
  }
};
HeldErrors errors_of_direct_pixels(const StripBuffers &buffers);
HeldErrors errors_of_demodulation(const StripBuffers &buffers);

// Goes behind the passes that leave them. Pixels that may be beyond what was asked for are listed in `later`,
// or counted where there is none.
Pass claims_pass(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later);

} // namespace pmdsim
