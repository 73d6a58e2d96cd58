#include "engine/view/points_pass.h"

#include "engine/lens/lens.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/sampling/sample_grid.h"
#include "engine/view/mesh_edges.h"
#include "engine/vulkan/float_pair.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <memory>

namespace pmdsim {
namespace {

// The passes on the device.
struct Points {
  shader::vec4 slope;
  vulkan::Buffer chip;
  vulkan::ComputePipeline pipeline;
};

// LensModel and its table, as they lie in the buffer.
struct LensRecord {
  shader::LensModel model;
  std::array<float, shader::lens_guesses> guesses;
};
static_assert(sizeof(LensRecord) == sizeof(shader::LensModel) + shader::lens_guesses * sizeof(float));

double distorted_radius_of_image(const Sensor &sensor, const Lens &lens) {
  const glm::dvec2 last(sensor.resolution);
  double radius = 0.0;
  for (const glm::dvec2 corner : {glm::dvec2(0), glm::dvec2(last.x, 0), glm::dvec2(0, last.y), last}) {
    const glm::dvec3 place = lens.lens_from_chip() * glm::dvec3(lens.on_chip_m(corner), 1.0);
    radius = std::max(radius, glm::length(glm::dvec2(place) / place.z));
  }
  return radius;
}

// How many times the distorted radius the undistorted one is, or the fisheye's angle. Newton's method gets
// the node below, from where it runs up to the root without passing the fold.
std::array<float, shader::lens_guesses> guesses_of(const Lens &lens, double nodes_per_radius) {
  std::array<float, shader::lens_guesses> guesses;
  float guess = 1.0f;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    if (i > 0)
      guess = static_cast<float>(lens.radial_inverse(static_cast<double>(i) / nodes_per_radius) *
                                 nodes_per_radius / static_cast<double>(i));
    guesses[i] = guess;
  }
  return guesses;
}

LensRecord lens_record(const Sensor &sensor) {
  const Lens lens(sensor);
  const double nodes_per_radius =
      (shader::lens_guesses - 1.0) / std::max(1e-9, distorted_radius_of_image(sensor, lens));
  const auto [k, p] = lens.coefficients();
  const DoublePair4 radial(glm::dvec4(k[0], k[1], k[2], k[3]));
  return {{chip_place(sensor), radial.hi, radial.lo, glm::vec4(float_pair(p[0]), float_pair(p[1])),
           static_cast<float>(nodes_per_radius), 0, 0, 0},
          guesses_of(lens, nodes_per_radius)};
}

vulkan::Buffer upload_lens(const vulkan::Device &device, const Sensor &sensor) {
  const LensRecord record = lens_record(sensor);
  return vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
}

vulkan::Buffer upload_views(const vulkan::Device &device, const std::vector<RasterBlock> &blocks) {
  std::vector<shader::RasterView> views;
  for (const RasterBlock &block : blocks) {
    const glm::mat3 rows(glm::transpose(block.raster_from_camera));
    views.push_back({glm::vec4(rows[0], 0), glm::vec4(rows[1], 0), glm::vec4(rows[2], 0), block.fragments.x,
                     block.fragments.y, 0, 0});
  }
  return vulkan::upload(device, views);
}

struct LensSearch {
  vulkan::Buffer lens, views, corners; // views: RasterView of each block
  vulkan::ComputePipeline pipeline;
};

} // namespace

Pass points_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                 std::uint32_t surface_vectors, const StripBuffers &buffers, const SceneBuffers &scene,
                 const vulkan::Buffer *list) {
  vulkan::ComputePipeline pipeline(device, vulkan::shader_module(device, precision, "points"),
                                   sizeof(shader::PointsConstants),
                                   {{shader::constant_surface_vectors, surface_vectors},
                                    {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
                                    {shader::constant_general_chip, !is_nominal(sensor)},
                                    {shader::constant_tiled, is_tiled(sensor)},
                                    {shader::constant_painted, scene.paint.painted},
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
          .list = list};
}

Pass lens_search_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                      const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
                      std::uint32_t surface_vectors, const StripBuffers &buffers,
                      const SceneBuffers &scene_buffers) {
  const bool fisheye = std::holds_alternative<Fisheye>(sensor.distortion);
  vulkan::ComputePipeline pipeline(
      device, vulkan::shader_module(device, precision, "lens_search"), sizeof(shader::LensSearchConstants),
      {{shader::constant_surface_vectors, surface_vectors},
       {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
       {shader::constant_distortion, fisheye ? shader::distortion_fisheye : shader::distortion_brown},
       {shader::constant_cutouts, scene_buffers.paint.cutouts},
       {shader::constant_painted, scene_buffers.paint.painted}});
  const auto made = std::make_shared<const LensSearch>(
      LensSearch{upload_lens(device, sensor), upload_views(device, blocks),
                 vulkan::upload(device, triangle_corners(camera, scene)), std::move(pipeline)});
  return {.name = "points",
          .reads = ids,
          .writes = ids | points,
          .record = [made, &buffers, &scene_buffers](const Recording &at) {
            const shader::LensSearchConstants constants{
                at.of_strip(),
                made->lens.words(),
                made->views.words(at.planned.block * sizeof(shader::RasterView)),
                buffers.fragments.words(),
                scene_buffers.planes.words(),
                made->corners.words(),
                buffers.ids.words(),
                buffers.position.words(),
                buffers.surface.words(),
                buffers.backscatter.words(),
                scene_buffers.paint.shapes.words(),
                scene_buffers.paint.surfaces.words()};
            made->pipeline.dispatch(at.commands, constants, sample_count(at.of_strip()),
                                    shader::workgroup_size);
          }};
}

} // namespace pmdsim
