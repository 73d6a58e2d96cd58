#include "engine/sampling/host/host_samples.h"

#include <stdexcept>

namespace pmdsim {

HostSamples::HostSamples(const StripBuffers &buffers, const vulkan::Buffer &planes, const Sensor &sensor,
                         const std::optional<ChipGrid> &records, bool has_fp64)
    : buffers_(buffers), planes_(planes), records_(records.has_value()), has_fp64_(has_fp64),
      tiled_(is_tiled(sensor)), slope_{} {
  if (!buffers.ids.is_mapped())
    throw std::logic_error("the host does not share the device's memory");
  if (!records)
    return;
  const shader::vec4 &slope = records->slope();
  slope_[0] = static_cast<double>(slope.x) + static_cast<double>(slope.y);
  slope_[1] = static_cast<double>(slope.z) + static_cast<double>(slope.w);
  if (!records->is_nominal())
    chip_ = records->place();
}

SampleSource HostSamples::of(const shader::Strip &strip) const {
  return {.strip = sample_strip(strip, records_),
          .ids = buffers_.ids.mapped().data(),
          .position = records_ ? nullptr : buffers_.position.mapped().data(),
          .planes = planes_.mapped_as<shader::TrianglePlane>(),
          .chip = chip_ ? &*chip_ : nullptr,
          .slope = {slope_[0], slope_[1]},
          .records = records_,
          .has_fp64 = has_fp64_,
          .tiled = tiled_};
}

} // namespace pmdsim
