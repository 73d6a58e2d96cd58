#include "engine/frame/uniform_pixels_pass.h"

#include "engine/sampling/chip_place.h"
#include "engine/signal/frequency_records.h"
#include "engine/signal/resolve_pass.h"
#include "engine/vulkan/forms.h"
#include "spirv/short_way_looped_double_float.h"
#include "spirv/short_way_looped_fp64.h"
#include "spirv/short_way_straight_double_float.h"
#include "spirv/short_way_straight_fp64.h"

#include <algorithm>
#include <cstring>
#include <numbers>

namespace pmdsim {
namespace {

const Forms forms{shader::short_way_straight_fp64_spirv, shader::short_way_straight_double_float_spirv,
                  shader::short_way_looped_fp64_spirv, shader::short_way_looped_double_float_spirv};

vulkan::Specialization constants_of(const Sensor &sensor, const DiodeGroups &groups, const SumModel &model,
                                    const Signal &signal, const ShortWayOptions &ways) {
  vulkan::Specialization constants = sum_constants(groups, model, signal, {false, false}, true);
  const vulkan::Specialization resolve =
      resolve_constants(signal, {is_tiled(sensor), false, Precision::fp32, {}}, true);
  constants.insert(constants.end(), resolve.begin(), resolve.end());
  const vulkan::Specialization points{1,
                                      sensor.vignetting == Vignetting::cos4 ? 1u : 0u,
                                      is_plain(sensor) ? 0u : 1u,
                                      0,
                                      ways.painted ? 1u : 0u,
                                      0};
  constants.insert(constants.end(), points.begin(), points.end());
  constants.push_back(ways.sums ? static_cast<std::uint32_t>(groups.runs.size()) : 0u);
  constants.insert(constants.end(),
                   {sensor.samples, ways.places, ways.lists ? 1u : 0u, ways.few_follow ? 1u : 0u});
  return constants;
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
      pipeline_(device, forms.choose(device, options), sizeof(shader::ShortWayConstants),
                constants_of(sensor, groups, model, signal, ways)) {
  shader::ShortWayLight light = light_record(extent, signal, groups.phased);
  light.diagrams = words(diagrams_.address());
  if (ways.sums) {
    std::ranges::copy(signal.all_tones(), light.tones);
    std::ranges::copy(frequency_records(signal, groups.largest_intensity_w_sr, promise), light.frequencies);
  }
  light_ = upload_light(device, light, light_runs(groups, promise));
  shader::ShortWayWork work{};
  work.lit_channel = signal.lit_channel();
  work.diodes = groups.diode_count;
  for (std::uint32_t list = 0; list < shader::pixel_lists; ++list)
    work.lists[list] = words(lists.of(list).address());
  work_ = vulkan::upload(device, std::as_bytes(std::span(&work, 1)));
}

void ShortWay::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                      const StripBuffers &buffers, const SceneBuffers &scene,
                      const vulkan::Buffer *few) const {
  const shader::ShortWayConstants constants{strip,
                                            slope_,
                                            words(chip_.address()),
                                            words(buffers.tags.address()),
                                            words(scene.planes.address()),
                                            words(scene.paint.shapes.address()),
                                            words(scene.paint.surfaces.address()),
                                            words(buffers.lit.address()),
                                            words(light_.address()),
                                            words(diodes_.address()),
                                            words(buffers.channels.address()),
                                            words(work_.address())};
  dispatch_listed(pipeline_, commands, constants, strip.padded_pixels, few, of_pixels);
}

} // namespace pmdsim
