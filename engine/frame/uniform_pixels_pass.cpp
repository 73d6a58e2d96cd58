#include "engine/frame/uniform_pixels_pass.h"

#include "engine/sampling/sample_grid.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/resolve_pass.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <cstring>
#include <numbers>

namespace pmdsim {
namespace {

std::uint32_t lists_of(const ShortWayOptions &ways) {
  if (!ways.lists)
    return shader::lists_no_pixel;
  return ways.few_follow ? shader::lists_in_three : shader::lists_in_two;
}

vulkan::Specialization constants_of(const vulkan::Device &device, const SimulatorOptions &options,
                                    const Sensor &sensor, const DiodeGroups &groups, const SumModel &model,
                                    const Signal &signal, const ShortWayOptions &ways) {
  return sum_constants(device, options, groups, model, signal, {})
      .merge(resolve_constants(signal, {is_tiled(sensor)}, true))
      .merge({{shader::constant_surface_vectors, 1},
              {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
              {shader::constant_general_chip, !is_plain(sensor)},
              {shader::constant_painted, ways.painted},
              {shader::constant_runs, ways.sums ? static_cast<std::uint32_t>(groups.runs.size()) : 0u},
              {shader::constant_side, sensor.samples},
              {shader::constant_places, ways.places},
              {shader::constant_lists_pixels, lists_of(ways)}});
}

shader::ShortWayLight light_record(const LightExtent &extent, const Signal &signal, bool phased) {
  const glm::dvec3 middle_m = 0.5 * (extent.box.low_m + extent.box.high_m);
  // A hair wider, as the shader compares in float.
  const glm::dvec3 half_m = 0.5 * (extent.box.high_m - extent.box.low_m) + 1e-6 * glm::abs(middle_m) + 1e-9;
  const auto [lowest_hz, highest_hz] =
      std::minmax_element(signal.modulation_hz.begin(), signal.modulation_hz.end());
  const double rad_m_hz = 2.0 * std::numbers::pi / speed_of_light_m_s;
  const double one_radian_m = 1.0 / (rad_m_hz * *lowest_hz);
  const double diameter_m = 2.0 * glm::length(half_m);
  shader::ShortWayLight record{};
  record.middle_m = glm::vec4(middle_m, 0.0);
  record.extent_m = glm::vec4(half_m, glm::length(half_m));
  record.pattern_slope = static_cast<float>(extent.pattern_slope);
  record.spread_m = static_cast<float>(phased ? one_radian_m : std::min(diameter_m, one_radian_m));
  record.wavenumber = static_cast<float>(rad_m_hz * *highest_hz);
  record.place_spread_m = static_cast<float>(place_spread_m);
  return record;
}

vulkan::Buffer upload_light(const vulkan::Device &device, shader::ShortWayLight light,
                            const std::vector<shader::LightRun> &runs) {
  std::vector<std::byte> bytes(sizeof(light) + runs.size() * sizeof(shader::LightRun));
  std::memcpy(bytes.data(), &light, sizeof(light));
  std::memcpy(bytes.data() + sizeof(light), runs.data(), runs.size() * sizeof(shader::LightRun));
  return vulkan::upload(device, bytes);
}

} // namespace

ShortWay::ShortWay(const vulkan::Device &device, const Sensor &sensor, const DiodeGroups &groups,
                   const LightExtent &extent, const SumModel &model, const Signal &signal,
                   const Promise &promise, const SimulatorOptions &options, const ShortWayOptions &ways,
                   const PixelLists &lists)
    : slope_(half_sample_slope(sensor)), chip_(upload_chip(device, sensor)),
      diodes_(upload_diodes(device, groups, {})),
      diagrams_(vulkan::upload(device, std::as_bytes(std::span(groups.diagrams)))),
      pipeline_(device, vulkan::shader_module(device, options.precision, "uniform_pixels"),
                sizeof(shader::ShortWayConstants),
                constants_of(device, options, sensor, groups, model, signal, ways)) {
  shader::ShortWayLight light = light_record(extent, signal, groups.phased);
  light.diagrams = diagrams_.words();
  if (ways.sums) {
    std::ranges::copy(signal.all_tones(), light.tones);
    std::ranges::copy(frequency_records(signal, groups.largest_intensity_w_sr, promise), light.frequencies);
  }
  light_ = upload_light(device, light, light_runs(groups, promise));
  shader::ShortWayWork work{};
  work.lit_channel = ChannelLayout(signal).lit_channel();
  work.diodes = groups.diode_count;
  for (std::uint32_t list = 0; list < shader::pixel_lists; ++list)
    work.lists[list] = lists.of(list).words();
  work_ = vulkan::upload(device, std::as_bytes(std::span(&work, 1)));
}

void ShortWay::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                      const StripBuffers &buffers, const SceneBuffers &scene,
                      const vulkan::Buffer *few) const {
  const shader::ShortWayConstants constants{strip,
                                            slope_,
                                            chip_.words(),
                                            buffers.tags.words(),
                                            scene.planes.words(),
                                            scene.paint.shapes.words(),
                                            scene.paint.surfaces.words(),
                                            buffers.lit.words(),
                                            light_.words(),
                                            diodes_.words(),
                                            buffers.channels.words(),
                                            work_.words()};
  dispatch_listed(pipeline_, commands, constants, strip.padded_pixels, few, of_pixels);
}

} // namespace pmdsim
