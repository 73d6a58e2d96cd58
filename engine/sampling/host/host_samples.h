#pragma once
// A strip's samples for the host's loops, where the host reads and writes the device's memory as its own.

#include "engine/sampling/host/sample_source.h"
#include "engine/sampling/sample_grid.h"
#include "engine/sampling/strip_memory.h"
#include "shaders/shared/interface.h"

#include <optional>

namespace pmdsim {

class HostSamples {
public:
  // `records`: where depths are all that is known of the samples; `has_fp64`: what a Real is;
  // `planes`: TrianglePlane of each shape.
  HostSamples(const StripBuffers &buffers, const vulkan::Buffer &planes, const Sensor &sensor,
              const std::optional<ChipGrid> &records, bool has_fp64);

  SampleSource of(const shader::Strip &strip) const;
  bool are_records() const { return records_; }

private:
  const StripBuffers &buffers_;
  const vulkan::Buffer &planes_;
  bool records_, has_fp64_, tiled_;
  std::optional<shader::ChipPlace> chip_;
  double slope_[2];
};

} // namespace pmdsim
