#include "engine/view/points_pass.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/sampling/sample_grid.h"
#include "shaders/shared/constants.h"

#include <memory>

namespace pmdsim {
namespace {

// The passes on the device.
struct Points {
  shader::vec4 slope;
  vulkan::Buffer chip;
  vulkan::ComputePipeline pipeline;
};

} // namespace

Pass points_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                 std::uint32_t surface_vectors, const StripBuffers &buffers, const SceneBuffers &scene,
                 const vulkan::Buffer *list) {
  vulkan::ComputePipeline pipeline(
      device, vulkan::shader_module(device, precision, "points"), sizeof(shader::PointsConstants),
      {{shader::constant_surface_vectors, surface_vectors},
       {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
       {shader::constant_general_chip, !is_nominal(sensor)},
       {shader::constant_tiled, is_tiled(sensor)},
       {shader::constant_painted, scene.paint.painted},
       {shader::constant_depth_records, buffers.id_bytes == sizeof(shader::uvec4)},
       {shader::constant_listed, list != nullptr}});
  const auto made = std::make_shared<const Points>(
      Points{half_sample_slope(sensor), upload_chip(device, sensor), std::move(pipeline)});
  return {.name = "points",
          .reads = ids | (list ? pixel_lists : no_resource),
          .writes = points,
          .record =
              [=, &buffers, &scene](const Recording &at) {
                const shader::PointsConstants constants{at.of_strip(),
                                                        made->slope,
                                                        made->chip.words(),
                                                        buffers.ids.words(),
                                                        scene.planes.words(),
                                                        buffers.position.words(),
                                                        buffers.surface.words(),
                                                        buffers.backscatter.words(),
                                                        scene.paint.shapes.words(),
                                                        scene.paint.surfaces.words(),
                                                        address_of(list)};
                dispatch_listed(made->pipeline, at.commands, constants, sample_count(at.of_strip()), list,
                                of_samples);
              },
          .prepare_warm_up = fill_with_one(list)};
}

} // namespace pmdsim
