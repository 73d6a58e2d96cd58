#include "engine/passes/resolve.h"

#include "engine/passes/double_pair.h"
#include "engine/passes/sample_precision.h"
#include "engine/vulkan/commands.h"
#include "spirv/resolve_double_float.h"
#include "spirv/resolve_fp64.h"

#include <cmath>
#include <numbers>

namespace pmdsim {
namespace {

float largest_float_below(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value ? nearest : std::nextafter(nearest, 0.0f);
}

} // namespace

ResolvePass::ResolvePass(const vulkan::Device &device, const Sensor &sensor, double largest_intensity_w_sr,
                         SamplePrecision precision)
    : ambiguity_m_(sensor.ambiguity_m()), amplitude_scale_(static_cast<float>(largest_intensity_w_sr)),
      pipeline_(device,
                choose(device, precision, shader::resolve_fp64_spirv, shader::resolve_double_float_spirv),
                sizeof(shader::ResolveConstants)) {}

void ResolvePass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                         const StripBuffers &buffers, const vulkan::Buffer &planes) const {
  vulkan::compute_barrier(commands);
  const DoublePair turns_per_m(1.0 / ambiguity_m_), ambiguity(ambiguity_m_);
  const shader::ResolveConstants constants{
      words(buffers.position_hi.address()),
      words(buffers.position_lo.address()),
      words(buffers.sum.address()),
      words(buffers.tags.address()),
      words(planes.address()),
      words(buffers.channels.address()),
      {turns_per_m.hi, turns_per_m.lo},
      {ambiguity.hi, ambiguity.lo},
      {largest_float_below(2.0 * std::numbers::pi), largest_float_below(ambiguity_m_)},
      amplitude_scale_,
      strip.columns,
      strip.samples,
      strip.padded_pixels,
      strip.columns * strip.rows};
  pipeline_.dispatch(commands, constants, strip.padded_pixels, shader::workgroup_size);
}

} // namespace pmdsim
