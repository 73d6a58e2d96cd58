#include "engine/signal/demodulation_pass.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/claims_pass.h"
#include "engine/signal/direct_pixels.h"
#include "engine/vulkan/commands.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <memory>
#include <string_view>

namespace pmdsim {
namespace {

// For depth records, as many as make a straight line that does not take long to compile: a divisor of their
// number, so that one pipeline does for all parts.
std::uint32_t frequencies_at_once(const Modulation &modulation) {
  constexpr std::uint32_t most = 8, most_planes = 16;
  std::uint32_t count =
      std::clamp(most_planes / modulation.planes, 1u, std::min(modulation.frequencies(), most));
  while (modulation.frequencies() % count != 0)
    --count;
  return count;
}

} // namespace

bool resolves_at_once(const Modulation &modulation) {
  return frequencies_at_once(modulation) == modulation.frequencies();
}

vulkan::Specialization demodulation_constants(const PassSetup &on, const SumScope &scope, bool first) {
  return {{shader::constant_planes, on.modulation.planes},
          {shader::constant_waveform, on.modulation.waveform},
          {shader::constant_taps, on.modulation.taps},
          {shader::constant_keep_taps, on.modulation.keep_taps},
          {shader::constant_ground_truth, first},
          {shader::constant_tiled, is_tiled(on.sensor)},
          {shader::constant_lit_is_kept, first && on.modulation.lit},
          {shader::constant_listed, scope.list != nullptr},
          {shader::constant_depth_records, on.buffers.id_bytes == sizeof(shader::uvec4)},
          {shader::constant_keeps_terms, on.modulation.keeps_terms},
          {shader::constant_beams, on.modulation.keeps_beams},
          {shader::constant_passes_on, scope.later != nullptr},
          {shader::constant_keeps_bounds, on.modulation.keeps_bounds},
          {shader::constant_keeps_rests, on.modulation.keeps_rests},
          {shader::constant_keeps_mean, on.modulation.keeps_mean},
          {shader::constant_reports_kept, on.modulation.keeps_terms && on.modulation.reports_kept},
          {shader::constant_precise_sum, scope.precision == Precision::fp64}};
}

bool leaves_errors(const Modulation &modulation, const SumScope &scope) {
  return holds_pixels(modulation) && scope.list == nullptr;
}

namespace {

std::vector<shader::Frequency> records_of(const PassSetup &on, const SourceGroups &groups,
                                          const SumScope &scope, const vulkan::Buffer &harmonics) {
  auto records =
      frequency_records(on.modulation, groups.largest_intensity_w_sr, scope.bound, groups.diode_count);
  for (shader::Frequency &record : records)
    record.harmonics = harmonics.words();
  return records;
}

// The pass on the device.
class Demodulation {
public:
  Demodulation(const PassSetup &on, const SourceGroups &groups, const SumScope &scope, bool leaves_truth);

  void record(const Recording &at) const;

private:
  vulkan::ComputePipeline make_pipeline(const PassSetup &on, bool first, bool leaves_truth) const;
  void record_samples(const Recording &at, std::uint32_t frequency) const;
  void record_depths(const Recording &at, std::uint32_t first_frequency) const;

  const StripBuffers &buffers_;
  const SceneBuffers &scene_;
  SumScope scope_;
  std::uint32_t frequencies_, at_once_;
  vk::DeviceSize sample_bytes_; // of the sum's planes of a frequency
  std::uint32_t lit_channel_, diodes_, side_;
  bool single_run_, leaves_errors_;
  vulkan::Buffer harmonics_;      // amplitudes
  vulkan::Buffer records_;        // shader::Frequency of each frequency
  vulkan::ComputePipeline first_; // of the frequencies: stores the ground truth, too
  vulkan::ComputePipeline later_; // all the others; empty where there are none
};

Demodulation::Demodulation(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                           bool leaves_truth)
    : buffers_(on.buffers), scene_(on.scene), scope_(scope), frequencies_(on.modulation.frequencies()),
      at_once_(scope.depth_records ? frequencies_at_once(on.modulation) : 1),
      lit_channel_(ChannelLayout(on.modulation).lit_channel()), diodes_(groups.diode_count),
      side_(on.sensor.samples), single_run_(groups.runs.size() == 1),
      leaves_errors_(leaves_errors(on.modulation, scope)),
      harmonics_(vulkan::upload(on.device, on.modulation.harmonics)),
      records_(vulkan::upload(on.device, records_of(on, groups, scope, harmonics_))),
      first_(make_pipeline(on, true, leaves_truth)) {
  const bool is_short = scope.depth_records && single_run_;
  sample_bytes_ = on.modulation.planes * (is_short ? sizeof(shader::vec2) : sizeof(shader::vec4));
  if (frequencies_ > at_once_)
    later_ = make_pipeline(on, false, leaves_truth);
}

vulkan::ComputePipeline Demodulation::make_pipeline(const PassSetup &on, bool first,
                                                    bool leaves_truth) const {
  vulkan::Specialization constants = demodulation_constants(on, scope_, first && !leaves_truth);
  const auto module = [&](std::string_view name) -> const vulkan::ShaderModule & {
    return vulkan::shader_module(on.device, on.options.precision, name);
  };
  constants.set(shader::constant_lit_is_kept, first && on.modulation.lit);
  if (!scope_.depth_records)
    constants.set(shader::constant_holds_pixels, leaves_errors_);
  if (!scope_.depth_records)
    return {on.device, module("demodulate"), sizeof(shader::DemodulationConstants), constants};
  constants.merge({{shader::constant_surface_vectors, 0},
                   {shader::constant_vignetting, on.sensor.vignetting == Vignetting::cos4},
                   {shader::constant_general_chip, !scope_.depth_records->is_nominal()},
                   {shader::constant_painted, on.scene.paint.painted},
                   {shader::constant_is_only, single_run_},
                   {shader::constant_side, side_},
                   {shader::constant_frequencies, at_once_},
                   {shader::constant_one_backscatter, on.scene.backscatter.has_value()}});
  return {on.device, module("demodulate_depths"), sizeof(shader::DepthDemodulationConstants), constants};
}

void Demodulation::record(const Recording &at) const {
  for (std::uint32_t f = 0; f < frequencies_; f += at_once_) {
    if (f > 0 && scope_.later) // of which the frequency before may have listed
      vulkan::compute_barrier(at.commands);
    if (scope_.depth_records)
      record_depths(at, f);
    else
      record_samples(at, f);
  }
}

void Demodulation::record_samples(const Recording &at, std::uint32_t frequency) const {
  const shader::Strip &strip = at.of_strip();
  const std::uint32_t plane = sample_count(strip);
  const HeldErrors errors = held_errors(buffers_, HeldErrors::By::demodulated_samples);
  const vk::DeviceSize of_frequency =
      errors.offset(strip) + sizeof(shader::vec2) * frequency * vk::DeviceSize{errors.plane(strip)};
  const shader::DemodulationConstants constants{buffers_.position.words(),
                                                buffers_.sum.words(sample_bytes_ * plane * frequency),
                                                buffers_.ids.words(),
                                                scene_.planes.words(),
                                                buffers_.channels.words(),
                                                records_.words(frequency * sizeof(shader::Frequency)),
                                                buffers_.lit.words(),
                                                buffers_.terms.words(),
                                                leaves_errors_ ? errors.in.words(of_frequency)
                                                               : buffers_.violations.words(),
                                                address_of(scope_.list),
                                                address_of(scope_.later),
                                                strip.columns,
                                                strip.samples,
                                                strip.padded_pixels,
                                                strip.columns * strip.rows,
                                                plane,
                                                lit_channel_,
                                                diodes_};
  dispatch_listed(frequency == 0 ? first_ : later_, at.commands, constants, strip.padded_pixels, scope_.list,
                  of_pixels);
}

void Demodulation::record_depths(const Recording &at, std::uint32_t first_frequency) const {
  const shader::Strip &strip = at.of_strip();
  const std::uint32_t plane = sample_count(strip);
  const shader::DepthDemodulationConstants constants{
      scope_.depth_records->of(strip),
      scope_.depth_records->chip(),
      buffers_.ids.words(),
      scene_.planes.words(),
      buffers_.sum.words(sample_bytes_ * plane * first_frequency),
      buffers_.channels.words(),
      buffers_.terms.words(),
      records_.words(first_frequency * sizeof(shader::Frequency)),
      scene_.paint.shapes.words(),
      scene_.paint.surfaces.words(),
      buffers_.lit.words(),
      strip.columns * strip.rows,
      strip.padded_pixels,
      plane,
      scene_.backscatter.value_or(0.0f)};
  (first_frequency == 0 ? first_ : later_)
      .dispatch(at.commands, constants, strip.padded_pixels, shader::workgroup_size);
}

} // namespace

Pass demodulation_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                       bool leaves_truth) {
  const auto demodulation = std::make_shared<const Demodulation>(on, groups, scope, leaves_truth);
  return {.name = "resolve",
          .reads = (scope.depth_records ? ids : ids | points) | sums | terms |
                   (on.modulation.lit ? visibility_counts : no_resource) |
                   (scope.list ? pixel_lists : no_resource),
          .writes = channels | terms | (scope.later ? pixel_lists : no_resource),
          .record = [demodulation](const Recording &at) { demodulation->record(at); },
          .prepare_warm_up = fill_with_one(scope.list)};
}

} // namespace pmdsim
