#pragma once
// The forms of a shader that sums diodes: as a straight line or with a loop, with fp64 or with pairs of
// floats.

#include "engine/vulkan/sample_precision.h"

namespace pmdsim {

struct Forms {
  std::span<const std::uint32_t> straight_fp64, straight_double_float, looped_fp64, looped_double_float;

  std::span<const std::uint32_t> choose(const vulkan::Device &device, const SimulatorOptions &options) const {
    const bool straight =
        options.loop == DiodeLoop::automatic ? device.is_cpu() : options.loop == DiodeLoop::straight_line;
    return straight ? pmdsim::choose(device, options.precision, straight_fp64, straight_double_float)
                    : pmdsim::choose(device, options.precision, looped_fp64, looped_double_float);
  }
};

} // namespace pmdsim
