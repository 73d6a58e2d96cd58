#include "engine/frame/uniform_pixels_pass.h"

#include "engine/sampling/sample_grid.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/demodulation_pass.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <span>

namespace pmdsim {
namespace {

std::uint32_t lists_of(const UniformPixels &pixels) {
  if (!pixels.lists)
    return shader::lists_no_pixel;
  if (!pixels.parts)
    return shader::lists_in_rest;
  return pixels.refines ? shader::lists_in_three : shader::lists_in_two;
}

vulkan::Specialization constants_of(const PassSetup &on, const SourceGroups &groups, const ErrorBound &bound,
                                    const UniformPixels &pixels) {
  return sum_constants(on, groups, {.bound = bound})
      .merge(demodulation_constants(on, {}, true))
      .merge({{shader::constant_surface_vectors, 1},
              {shader::constant_vignetting, on.sensor.vignetting == Vignetting::cos4},
              {shader::constant_general_chip, !is_nominal(on.sensor)},
              {shader::constant_painted, on.scene.paint.painted},
              {shader::constant_runs, pixels.sums ? static_cast<std::uint32_t>(groups.runs.size()) : 0u},
              {shader::constant_side, on.sensor.samples},
              {shader::constant_quadrature_points, pixels.points},
              {shader::constant_lists_pixels, lists_of(pixels)}})
      .set(shader::constant_ground_truth, !pixels.leaves_truth);
}

shader::UniformPixelsLight light_record(const LightExtent &extent, const Modulation &modulation,
                                        bool phased) {
  const glm::dvec3 middle_m = 0.5 * (extent.box.low_m + extent.box.high_m);
  // A hair wider, as the shader compares in float.
  const glm::dvec3 half_m = 0.5 * (extent.box.high_m - extent.box.low_m) + 1e-6 * glm::abs(middle_m) + 1e-9;
  const auto [lowest_hz, highest_hz] =
      std::minmax_element(modulation.modulation_hz.begin(), modulation.modulation_hz.end());
  const double rad_m_hz = 2.0 * std::numbers::pi / speed_of_light_m_s;
  const double one_radian_m = 1.0 / (rad_m_hz * *lowest_hz);
  const double diameter_m = 2.0 * glm::length(half_m);
  shader::UniformPixelsLight record{};
  record.middle_m = glm::vec4(middle_m, 0.0);
  record.extent_m = glm::vec4(half_m, glm::length(half_m));
  record.pattern_slope = static_cast<float>(extent.pattern_slope);
  record.spread_m = static_cast<float>(phased ? one_radian_m : std::min(diameter_m, one_radian_m));
  record.wavenumber = static_cast<float>(rad_m_hz * *highest_hz);
  record.point_spread_m = static_cast<float>(point_spread_m);
  return record;
}

// The record, and behind it what the sources share.
vulkan::Buffer upload_light(const PassSetup &on, const SourceGroups &groups, const LightExtent &extent,
                            const ErrorBound &bound, bool sums, const vulkan::Buffer &diagrams) {
  shader::UniformPixelsLight light = light_record(extent, on.modulation, groups.phased);
  light.diagrams = diagrams.words();
  if (sums) {
    std::ranges::copy(on.modulation.all_tones(), light.tones);
    std::ranges::copy(
        frequency_records(on.modulation, groups.largest_intensity_w_sr, bound, groups.diode_count),
        light.frequencies);
  }
  const std::vector<shader::LightRun> runs = light_runs(groups, bound);
  std::vector<std::byte> bytes(sizeof(light) + runs.size() * sizeof(shader::LightRun));
  std::memcpy(bytes.data(), &light, sizeof(light));
  std::memcpy(bytes.data() + sizeof(light), runs.data(), runs.size() * sizeof(shader::LightRun));
  return vulkan::upload(on.device, bytes);
}

vulkan::Buffer upload_work(const PassSetup &on, const SourceGroups &groups, const PixelLists &lists) {
  shader::UniformPixelsWork work{};
  work.violations = on.buffers.violations.words();
  work.lit_channel = ChannelLayout(on.modulation).lit_channel();
  work.diodes = groups.diode_count;
  for (std::uint32_t list = 0; list < shader::pixel_lists; ++list)
    work.lists[list] = lists.of(list).words();
  return vulkan::upload(on.device, std::as_bytes(std::span(&work, 1)));
}

// The pass on the device.
struct OnDevice {
  OnDevice(const PassSetup &on, const SourceGroups &groups, const LightExtent &extent,
           const ErrorBound &bound, const UniformPixels &pixels, const PixelLists &lists)
      : slope(half_sample_slope(on.sensor)), chip(upload_chip(on.device, on.sensor)),
        diodes(upload_diodes(on.device, groups, {})), diagrams(vulkan::upload(on.device, groups.diagrams)),
        light(upload_light(on, groups, extent, bound, pixels.sums, diagrams)),
        work(upload_work(on, groups, lists)),
        pipeline(on.device, vulkan::shader_module(on.device, on.options.precision, "uniform_pixels"),
                 sizeof(shader::UniformPixelsConstants), constants_of(on, groups, bound, pixels)) {}

  shader::vec4 slope;
  vulkan::Buffer chip, diodes, diagrams, light, work;
  vulkan::ComputePipeline pipeline;
};

} // namespace

Pass uniform_pixels_pass(const PassSetup &on, const SourceGroups &groups, const LightExtent &extent,
                         const ErrorBound &bound, const UniformPixels &pixels,
                         const std::shared_ptr<const PixelLists> &lists) {
  const auto made = std::make_shared<const OnDevice>(on, groups, extent, bound, pixels, *lists);
  const vulkan::Buffer *const few = pixels.points == 4 ? &lists->of(shader::list_refined) : nullptr;
  const auto record = [=, &buffers = on.buffers, &scene = on.scene](const Recording &at) {
    const shader::Strip &strip = at.of_strip();
    const shader::UniformPixelsConstants constants{strip,
                                                   made->slope,
                                                   made->chip.words(),
                                                   buffers.ids.words(),
                                                   scene.planes.words(),
                                                   scene.paint.shapes.words(),
                                                   scene.paint.surfaces.words(),
                                                   buffers.lit.words(),
                                                   made->light.words(),
                                                   made->diodes.words(),
                                                   buffers.channels.words(),
                                                   made->work.words()};
    if (!few)
      lists->record_clear(at.commands);
    dispatch_listed(made->pipeline, at.commands, constants, strip.padded_pixels, few, of_pixels);
    lists->record_count(at.commands, strip.samples * strip.samples);
  };
  return {.name = "short_way",
          .reads =
              ids | (on.modulation.lit ? visibility_counts : no_resource) | (few ? pixel_lists : no_resource),
          .writes = channels | pixel_lists,
          .record = record,
          .prepare_warm_up = fill_with_one(few)};
}

} // namespace pmdsim
