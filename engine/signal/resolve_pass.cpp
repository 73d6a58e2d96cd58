#include "engine/signal/resolve_pass.h"

#include "engine/signal/channel_layout.h"
#include "shaders/shared/constants.h"

#include <algorithm>

namespace pmdsim {
vulkan::Specialization resolve_constants(const Signal &signal, const ResolvePass::Scope &scope, bool first) {
  return {{shader::constant_planes, signal.planes},
          {shader::constant_waveform, signal.waveform},
          {shader::constant_taps, signal.taps},
          {shader::constant_keep_taps, signal.keep_taps},
          {shader::constant_ground_truth, first},
          {shader::constant_tiled, scope.tiled},
          {shader::constant_lit_is_kept, first && signal.lit},
          {shader::constant_listed, scope.listed},
          {shader::constant_promised, signal.promised},
          {shader::constant_precise_sum, scope.precision == Precision::fp64}};
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
  return constants.merge({{shader::constant_surface_vectors, 0},
                          {shader::constant_vignetting, plain.vignetting},
                          {shader::constant_general_chip, !plain.grid.is_nominal()},
                          {shader::constant_painted, plain.painted},
                          {shader::constant_is_only, plain.single_run},
                          {shader::constant_side, plain.samples},
                          {shader::constant_frequencies, frequencies_at_once(signal)},
                          {shader::constant_one_backscatter, plain.one_backscatter}});
}

vulkan::ComputePipeline make_pipeline(const vulkan::Device &device, const Signal &signal,
                                      SamplePrecision precision, const ResolvePass::Scope &scope,
                                      bool first) {
  if (scope.plain)
    return {device, vulkan::shader_module(device, precision, "resolve_plain"),
            sizeof(shader::PlainResolveConstants), plain_constants(signal, scope, first)};
  return {device, vulkan::shader_module(device, precision, "resolve"), sizeof(shader::ResolveConstants),
          resolve_constants(signal, scope, first)};
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
    const shader::ResolveConstants constants{buffers.position.words(),
                                             buffers.sum.words(first_plane * plane * sizeof(shader::vec4)),
                                             buffers.tags.words(),
                                             scene.planes.words(),
                                             buffers.channels.words(),
                                             harmonics_.words(),
                                             frequencies_.words(f * sizeof(shader::Frequency)),
                                             buffers.lit.words(),
                                             buffers.terms.words(),
                                             buffers.broken.words(),
                                             address_of(list),
                                             strip.columns,
                                             strip.samples,
                                             strip.padded_pixels,
                                             strip.columns * strip.rows,
                                             plane,
                                             ChannelLayout(signal_).lit_channel(),
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
      buffers.tags.words(),
      scene.planes.words(),
      buffers.sum.words(first_plane * plane * sum_bytes),
      buffers.channels.words(),
      harmonics_.words(),
      frequencies_.words(first_frequency * sizeof(shader::Frequency)),
      scene.paint.shapes.words(),
      scene.paint.surfaces.words(),
      strip.columns * strip.rows,
      strip.padded_pixels,
      plane,
      scene.backscatter.value_or(0.0f)};
  (first_frequency == 0 ? first_ : later_)
      .dispatch(commands, constants, strip.padded_pixels, shader::workgroup_size);
}

} // namespace pmdsim
