#pragma once
// The use of the errors that pixels of a frame of depth records may have: the frame's claim, and the pixels
// that a later class sums again.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Where those errors have been left, as ClaimsConstants::errors: by direct_pixels.comp, by
// demodulate_depths.comp, or by demodulate.comp, behind the terms of the samples.
struct HeldErrors {
  const vulkan::Buffer &in;
  Resources resource;
  enum class By { direct_pixels, demodulated_depths, demodulated_samples } by;
  std::uint32_t terms; // of each sample, floats

  std::uint32_t plane(const shader::Strip &strip) const {
    return by == By::direct_pixels ? sample_count(strip) : strip.padded_pixels;
  }
  vk::DeviceSize offset(const shader::Strip &strip) const {
    return by == By::demodulated_samples ? terms * sizeof(float) * vk::DeviceSize{sample_count(strip)} : 0;
  }
};
HeldErrors held_errors(const StripBuffers &buffers, HeldErrors::By by);

// Goes behind the passes that leave them. Pixels that may be beyond what was asked for are listed in `later`,
// or counted where there is none.
Pass claims_pass(const PassSetup &on, const HeldErrors &errors, const vulkan::Buffer *later);

} // namespace pmdsim
