#pragma once
// A random set of a frame's pixels, evaluated again with every sample and every diode, to find its error.

#include "engine/light/accumulate_pass.h"
#include "engine/model/measurement.h"

#include <memory>
#include <vector>

namespace pmdsim {

class SpotCheck {
public:
  // The pixels are the same for every frame of a resolution.
  SpotCheck(const PassSetup &on, const std::vector<PlannedStrip> &strips);

  const vulkan::Buffer &list() const { return *list_; }
  // Fills the list with the strip's pixels.
  Pass list_pass() const;
  // Puts the largest difference of the measured strip from the channels that were read back into the
  // measurement's report. Returns with a stored bound beyond the limit are left out.
  void compare(std::size_t strip, const shader::Strip &of, const StripBuffers &buffers, double limit_m,
               Measurement &measured) const;

private:
  Modulation modulation_;
  std::vector<std::vector<std::uint32_t>> of_strip_; // pixels, counted within the strip
  std::shared_ptr<const vulkan::Buffer> list_;
};

} // namespace pmdsim
