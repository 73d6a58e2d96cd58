#include "engine/view/points_pass.h"

#include "engine/sampling/raster_blocks.h"
#include "engine/sampling/sample_grid.h"
#include "shaders/shared/constants.h"

namespace pmdsim {

PointsPass::PointsPass(const vulkan::Device &device, const Sensor &sensor, std::uint32_t surface_vectors,
                       bool painted, SamplePrecision precision, bool listed)
    : slope_(half_sample_slope(sensor)), chip_(upload_chip(device, sensor)),
      pipeline_(device, vulkan::shader_module(device, precision, "points"), sizeof(shader::PointsConstants),
                {{shader::constant_surface_vectors, surface_vectors},
                 {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
                 {shader::constant_general_chip, !is_plain(sensor)},
                 {shader::constant_tiled, is_tiled(sensor)},
                 {shader::constant_painted, painted},
                 {shader::constant_listed, listed}}) {}

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
