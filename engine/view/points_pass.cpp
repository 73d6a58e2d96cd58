#include "engine/view/points_pass.h"

#include "engine/sampling/chip_place.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/vulkan/sample_precision.h"
#include "spirv/points_double_float.h"
#include "spirv/points_fp64.h"

namespace pmdsim {

PointsPass::PointsPass(const vulkan::Device &device, const Sensor &sensor, std::uint32_t surface_vectors,
                       bool painted, SamplePrecision precision, bool listed)
    : slope_(half_sample_slope(sensor)), chip_(upload_chip(device, sensor)),
      pipeline_(device,
                choose(device, precision, shader::points_fp64_spirv, shader::points_double_float_spirv),
                sizeof(shader::PointsConstants),
                {surface_vectors, sensor.vignetting == Vignetting::cos4 ? 1u : 0u, is_plain(sensor) ? 0u : 1u,
                 is_tiled(sensor) ? 1u : 0u, painted ? 1u : 0u, listed ? 1u : 0u}) {}

void PointsPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                        const StripBuffers &buffers, const SceneBuffers &scene,
                        const vulkan::Buffer *list) const {
  const shader::PointsConstants constants{strip,
                                          slope_,
                                          chip_.words(),
                                          buffers.tags.words(),
                                          scene.planes.words(),
                                          buffers.position.words(),
                                          buffers.surface.words(),
                                          buffers.backscatter.words(),
                                          scene.paint.shapes.words(),
                                          scene.paint.surfaces.words(),
                                          address_of(list)};
  dispatch_listed(pipeline_, commands, constants, sample_count(strip), list, of_samples);
}

} // namespace pmdsim
