#include "engine/shadow/tile_shadow_pipelines.h"

#include "shaders/shadow/lit_interface.h"
#include "shaders/shared/constants.h"

namespace pmdsim {
namespace {

// Invocations that try a part's candidates: on a CPU as few as its vectors have lanes, so that what one of
// them loads serves many samples; on a GPU one for each sample.
std::uint32_t lanes_to_try(const vulkan::Device &device) {
  return device.is_cpu() ? 8 : shader::tile_samples;
}

} // namespace

LitPipelines make_lit_pipelines(const vulkan::Device &device, const std::vector<SourceWindow> &windows,
                                const LitForm &form, SamplePrecision precision) {
  vulkan::Specialization constants{{shader::constant_tiled, form.tiled},
                                   {shader::constant_cutouts, form.cutouts},
                                   {shader::constant_flat_bundles, form.flat},
                                   {shader::constant_lanes, lanes_to_try(device)},
                                   {shader::constant_is_first, 1}};
  const auto pipeline = [&](std::string_view name, std::size_t push_constant_bytes) {
    return vulkan::ComputePipeline(device, vulkan::shader_module(device, precision, name),
                                   push_constant_bytes, constants);
  };
  LitPipelines made;
  made.tiles = pipeline("lit_tiles", sizeof(shader::LitTilesConstants));
  made.open = pipeline("lit_open", sizeof(shader::LitGatherConstants));
  made.gather = pipeline("lit_gather", sizeof(shader::LitGatherConstants));
  made.attempt = pipeline("lit_try", sizeof(shader::LitDecideConstants));
  made.clear = pipeline("lit_clear", sizeof(shader::LitDecideConstants));
  made.trace = pipeline("lit_trace", sizeof(shader::LitDecideConstants));
  for (const SourceWindow &window : windows) {
    constants.set(shader::constant_bundles, window.bundles)
        .set(shader::constant_is_first, made.counts.empty());
    made.counts.push_back(pipeline("lit_count", sizeof(shader::LitCountConstants)));
  }
  constants.set(shader::constant_is_first, 0);
  made.walk = pipeline("lit_trace", sizeof(shader::LitDecideConstants));
  return made;
}

} // namespace pmdsim
