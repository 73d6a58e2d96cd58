#pragma once
// Which form of the shaders' extended precision a device runs.

#include "engine/model/simulator_options.h"
#include "engine/vulkan/device.h"

#include <cstdint>
#include <span>

namespace pmdsim {

inline bool uses_fp64(const vulkan::Device &device, SamplePrecision wanted) {
  return device.has_fp64() && wanted == SamplePrecision::automatic;
}

// One of the two forms of a shader: with fp64 or with pairs of floats.
inline std::span<const std::uint32_t> choose(const vulkan::Device &device, SamplePrecision wanted,
                                             std::span<const std::uint32_t> fp64,
                                             std::span<const std::uint32_t> double_float) {
  return uses_fp64(device, wanted) ? fp64 : double_float;
}

} // namespace pmdsim
