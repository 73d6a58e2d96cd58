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

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const Signal &signal,
                                      SamplePrecision precision, Precision sum, bool tiled, bool first) {
  return {device,
          choose(device, precision, shader::resolve_fp64_spirv, shader::resolve_double_float_spirv),
          sizeof(shader::ResolveConstants),
          {signal.planes, signal.waveform, signal.taps, signal.keep_taps ? 1u : 0u, first ? 1u : 0u,
           tiled ? 1u : 0u, first && signal.lit ? 1u : 0u, sum == Precision::fp64 ? 1u : 0u}};
}

} // namespace

ResolvePass::ResolvePass(const vulkan::Device &device, const Signal &signal, const DiodeGroups &groups,
                         bool tiled, SamplePrecision precision, Precision sum)
    : signal_(signal), amplitude_scale_(static_cast<float>(groups.largest_intensity_w_sr)),
      diodes_(groups.diode_count),
      harmonics_(vulkan::upload(device, std::as_bytes(std::span(signal.harmonics)))),
      first_(make_pipeline(device, signal, precision, sum, tiled, true)) {
  if (signal.frequencies() > 1)
    later_ = make_pipeline(device, signal, precision, sum, tiled, false);
}

void ResolvePass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                         const StripBuffers &buffers, const vulkan::Buffer &planes) const {
  vulkan::compute_barrier(commands);
  const std::uint32_t plane = sample_count(strip);
  for (std::uint32_t f = 0; f < signal_.frequencies(); ++f) {
    const double ambiguity_m = speed_of_light_m_s / (2.0 * signal_.modulation_hz[f]);
    const DoublePair turns_per_m(1.0 / ambiguity_m), ambiguity(ambiguity_m);
    const vk::DeviceSize first_plane = vk::DeviceSize{f} * signal_.planes;
    const shader::ResolveConstants constants{
        words(buffers.position_hi.address()),
        words(buffers.position_lo.address()),
        words(buffers.sum.address() + first_plane * plane * sizeof(shader::vec4)),
        words(buffers.tags.address()),
        words(planes.address()),
        words(buffers.channels.address()),
        words(harmonics_.address()),
        {turns_per_m.hi, turns_per_m.lo},
        {ambiguity.hi, ambiguity.lo},
        {largest_float_below(2.0 * std::numbers::pi), largest_float_below(ambiguity_m)},
        amplitude_scale_,
        strip.columns,
        strip.samples,
        strip.padded_pixels,
        strip.columns * strip.rows,
        plane,
        signal_.first_channel(f),
        signal_.lit_channel(),
        words(buffers.lit.address()),
        diodes_};
    (f == 0 ? first_ : later_).dispatch(commands, constants, strip.padded_pixels, shader::workgroup_size);
  }
}

} // namespace pmdsim
