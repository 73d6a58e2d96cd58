#include "engine/signal/resolve_pass.h"

#include "engine/signal/frequency_records.h"
#include "engine/vulkan/sample_precision.h"
#include "spirv/resolve_double_float.h"
#include "spirv/resolve_fp64.h"
#include "spirv/resolve_plain_double_float.h"
#include "spirv/resolve_plain_fp64.h"

#include <algorithm>

namespace pmdsim {
vulkan::Specialization resolve_constants(const Signal &signal, const ResolvePass::Scope &scope, bool first) {
  return {signal.planes,
          signal.waveform,
          signal.taps,
          signal.keep_taps ? 1u : 0u,
          first ? 1u : 0u,
          scope.tiled ? 1u : 0u,
          first && signal.lit ? 1u : 0u,
          scope.listed ? 1u : 0u,
          signal.promised ? 1u : 0u,
          scope.precision == Precision::fp64 ? 1u : 0u};
}

namespace {

// Of the plain way, as one straight line, which should not take long to compile: a divisor of their number,
// so that one pipeline does for all parts.
std::uint32_t frequencies_at_once(const Signal &signal) {
  constexpr std::uint32_t most = 8, most_planes = 16;
  std::uint32_t count = std::clamp(most_planes / signal.planes, 1u, std::min(signal.frequencies(), most));
  while (signal.frequencies() % count != 0)
    --count;
  return count;
}

vulkan::Specialization plain_constants(const Signal &signal, const ResolvePass::Scope &scope, bool first) {
  const ResolvePass::PlainScope &plain = *scope.plain;
  vulkan::Specialization constants = resolve_constants(signal, scope, first && !plain.truth_of_records);
  const vulkan::Specialization points{0, plain.vignetting ? 1u : 0u, plain.grid.is_nominal() ? 0u : 1u,
                                      0, plain.painted ? 1u : 0u,    0};
  constants.insert(constants.end(), points.begin(), points.end());
  constants.insert(constants.end(), {plain.single_run ? 1u : 0u, plain.samples, frequencies_at_once(signal),
                                     plain.one_backscatter ? 1u : 0u});
  return constants;
}

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const Signal &signal,
                                      SamplePrecision precision, const ResolvePass::Scope &scope,
                                      bool first) {
  const auto of = [&](std::span<const std::uint32_t> fp64, std::span<const std::uint32_t> double_float) {
    return choose(device, precision, fp64, double_float);
  };
  if (scope.plain)
    return {device, of(shader::resolve_plain_fp64_spirv, shader::resolve_plain_double_float_spirv),
            sizeof(shader::PlainResolveConstants), plain_constants(signal, scope, first)};
  return {device, of(shader::resolve_fp64_spirv, shader::resolve_double_float_spirv),
          sizeof(shader::ResolveConstants), resolve_constants(signal, scope, first)};
}

vulkan::Buffer upload_frequencies(const vulkan::Device &device, const Signal &signal,
                                  const DiodeGroups &groups, const std::optional<Promise> &promise) {
  const auto records = frequency_records(signal, groups.largest_intensity_w_sr, promise);
  return vulkan::upload(device, std::as_bytes(std::span(records)));
}

} // namespace

ResolvePass::ResolvePass(const vulkan::Device &device, const Signal &signal, const DiodeGroups &groups,
                         const SimulatorOptions &options, const Scope &scope)
    : signal_(signal), plain_(scope.plain), diodes_(groups.diode_count),
      frequencies_(upload_frequencies(device, signal, groups, scope.promise)),
      harmonics_(vulkan::upload(device, std::as_bytes(std::span(signal.harmonics)))),
      first_(make_pipeline(device, signal, options.precision, scope, true)) {
  if (signal.frequencies() > (scope.plain ? frequencies_at_once(signal) : 1))
    later_ = make_pipeline(device, signal, options.precision, scope, false);
}

void ResolvePass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                         const StripBuffers &buffers, const SceneBuffers &scene,
                         const vulkan::Buffer *list) const {
  if (plain_) {
    for (std::uint32_t f = 0; f < signal_.frequencies(); f += frequencies_at_once(signal_))
      record_plain(commands, strip, buffers, scene, f);
    return;
  }
  const std::uint32_t plane = sample_count(strip);
  for (std::uint32_t f = 0; f < signal_.frequencies(); ++f) {
    const vk::DeviceSize first_plane = vk::DeviceSize{f} * signal_.planes;
    const shader::ResolveConstants constants{
        words(buffers.position.address()),
        words(buffers.sum.address() + first_plane * plane * sizeof(shader::vec4)),
        words(buffers.tags.address()),
        words(scene.planes.address()),
        words(buffers.channels.address()),
        words(harmonics_.address()),
        words(frequencies_.address() + f * sizeof(shader::Frequency)),
        words(buffers.lit.address()),
        words(buffers.terms.address()),
        words(buffers.broken.address()),
        address_of(list),
        strip.columns,
        strip.samples,
        strip.padded_pixels,
        strip.columns * strip.rows,
        plane,
        signal_.lit_channel(),
        diodes_};
    dispatch_listed(f == 0 ? first_ : later_, commands, constants, strip.padded_pixels, list, of_pixels);
  }
}

void ResolvePass::record_plain(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                               const StripBuffers &buffers, const SceneBuffers &scene,
                               std::uint32_t first_frequency) const {
  const std::uint32_t plane = sample_count(strip);
  const vk::DeviceSize sum_bytes = plain_->single_run ? sizeof(shader::vec2) : sizeof(shader::vec4);
  const vk::DeviceSize first_plane = vk::DeviceSize{first_frequency} * signal_.planes;
  const shader::PlainResolveConstants constants{
      plain_->grid.of(strip),
      plain_->grid.chip(),
      words(buffers.tags.address()),
      words(scene.planes.address()),
      words(buffers.sum.address() + first_plane * plane * sum_bytes),
      words(buffers.channels.address()),
      words(harmonics_.address()),
      words(frequencies_.address() + first_frequency * sizeof(shader::Frequency)),
      words(scene.paint.shapes.address()),
      words(scene.paint.surfaces.address()),
      strip.columns * strip.rows,
      strip.padded_pixels,
      plane,
      scene.backscatter.value_or(0.0f)};
  (first_frequency == 0 ? first_ : later_)
      .dispatch(commands, constants, strip.padded_pixels, shader::workgroup_size);
}

} // namespace pmdsim
