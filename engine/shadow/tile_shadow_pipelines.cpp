#include "engine/shadow/tile_shadow_pipelines.h"

#include "engine/vulkan/sample_precision.h"
#include "spirv/lit_clear_double_float.h"
#include "spirv/lit_clear_fp64.h"
#include "spirv/lit_count.h"
#include "spirv/lit_gather_double_float.h"
#include "spirv/lit_gather_fp64.h"
#include "spirv/lit_open.h"
#include "spirv/lit_tiles_double_float.h"
#include "spirv/lit_tiles_fp64.h"
#include "spirv/lit_trace_double_float.h"
#include "spirv/lit_trace_fp64.h"
#include "spirv/lit_try_double_float.h"
#include "spirv/lit_try_fp64.h"

namespace pmdsim {
namespace {

// Invocations that try a part's candidates: on a CPU as few as its vectors have lanes, so that what one of
// them loads serves many samples; on a GPU one for each sample.
std::uint32_t lanes_to_try(const vulkan::Device &device) {
  return device.is_cpu() ? 8 : shader::tile_samples;
}

} // namespace

LitPipelines make_lit_pipelines(const vulkan::Device &device, const std::vector<LitWindow> &windows,
                                const LitForm &form, SamplePrecision precision) {
  const std::uint32_t lanes = lanes_to_try(device);
  const auto pipeline = [&](std::span<const std::uint32_t> fp64, std::span<const std::uint32_t> double_float,
                            std::size_t constants, const vulkan::Specialization &specialization) {
    return vulkan::ComputePipeline(device, choose(device, precision, fp64, double_float),
                                   static_cast<std::uint32_t>(constants), specialization);
  };
  const auto tracing = [&](bool again) {
    return pipeline(shader::lit_trace_fp64_spirv, shader::lit_trace_double_float_spirv,
                    sizeof(shader::LitDecideConstants),
                    {form.tiled ? 1u : 0u, form.masked ? 1u : 0u, again ? 1u : 0u});
  };
  LitPipelines made{
      pipeline(shader::lit_tiles_fp64_spirv, shader::lit_tiles_double_float_spirv,
               sizeof(shader::LitTilesConstants), {form.tiled ? 1u : 0u}),
      pipeline(shader::lit_open_spirv, shader::lit_open_spirv, sizeof(shader::LitGatherConstants), {}),
      pipeline(shader::lit_gather_fp64_spirv, shader::lit_gather_double_float_spirv,
               sizeof(shader::LitGatherConstants), {form.tiled ? 1u : 0u}),
      pipeline(shader::lit_try_fp64_spirv, shader::lit_try_double_float_spirv,
               sizeof(shader::LitDecideConstants),
               {form.tiled ? 1u : 0u, lanes, shader::tile_samples / lanes, form.flat ? 1u : 0u}),
      pipeline(shader::lit_clear_fp64_spirv, shader::lit_clear_double_float_spirv,
               sizeof(shader::LitDecideConstants), {form.tiled ? 1u : 0u}),
      tracing(false),
      tracing(true),
      {}};
  for (const LitWindow &window : windows)
    made.counts.push_back(pipeline(shader::lit_count_spirv, shader::lit_count_spirv,
                                   sizeof(shader::LitCountConstants),
                                   {window.bundles, made.counts.empty() ? 1u : 0u}));
  return made;
}

} // namespace pmdsim
