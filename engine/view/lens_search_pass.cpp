#include "engine/view/lens_search_pass.h"

#include "engine/lens/lens.h"
#include "engine/sampling/sample_grid.h"
#include "engine/view/mesh_edges.h"
#include "engine/view/rim_cells.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/compute_pipeline.h"
#include "engine/vulkan/float_pair.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <memory>

namespace pmdsim {
namespace {

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

// The undistorted radius, or the fisheye's angle, over the distorted radius. Newton's method gets the node
// below, from where it runs up to the root without passing the fold.
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
           static_cast<float>(nodes_per_radius), static_cast<float>(lens.fold_radius()),
           static_cast<float>(lens.fold_distorted()), 0},
          guesses_of(lens, nodes_per_radius)};
}

vulkan::Buffer upload_lens(const vulkan::Device &device, const Sensor &sensor) {
  const LensRecord record = lens_record(sensor);
  return vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
}

vulkan::Buffer upload_views(const vulkan::Device &device, const std::vector<RasterBlock> &blocks) {
  std::vector<shader::RasterView> views;
  for (const RasterBlock &block : blocks) {
    const glm::mat3 rows(glm::transpose(block.raster_from_camera)),
        rays(glm::inverse(block.raster_from_camera));
    views.push_back({glm::vec4(rows[0], 0), glm::vec4(rows[1], 0), glm::vec4(rows[2], 0),
                     glm::vec4(rays[0], 0), glm::vec4(rays[1], 0), glm::vec4(rays[2], 0), block.fragments.x,
                     block.fragments.y, 0, 0});
  }
  return vulkan::upload(device, views);
}

struct LensSearch {
  vulkan::Buffer lens, views, corners; // views: RasterView of each block
  vulkan::Buffer rim_cells, candidates;
  std::vector<std::uint32_t> end_of_block; // in rim_cells
  vulkan::ComputePipeline mark_rims, search;
};

LensSearch make_search(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                       const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
                       const vulkan::Specialization &constants) {
  const std::vector<shader::TriangleCorners> corners = triangle_corners(camera, scene);
  RimCells rims = find_rim_cells(camera, scene, corners, blocks);
  return {upload_lens(device, sensor),
          upload_views(device, blocks),
          vulkan::upload(device, corners),
          vulkan::upload(device, rims.cells),
          vulkan::upload(device, rims.candidates),
          std::move(rims.end_of_block),
          vulkan::ComputePipeline(device, vulkan::shader_module(device, precision, "mark_rims"),
                                  sizeof(shader::MarkRimsConstants)),
          vulkan::ComputePipeline(device, vulkan::shader_module(device, precision, "lens_search"),
                                  sizeof(shader::LensSearchConstants), constants)};
}

// Marks a block's rim cells, also where it has none: lavapipe compiles at the first dispatch.
void mark_rims(const LensSearch &made, const Recording &at, const vulkan::Buffer &fragments) {
  if (made.rim_cells.bytes() == 0)
    return;
  const std::uint32_t block = at.planned.block, first = block > 0 ? made.end_of_block[block - 1] : 0;
  const std::uint32_t count = made.end_of_block[block] - first;
  const shader::MarkRimsConstants constants{fragments.words(),
                                            made.rim_cells.words(first * sizeof(shader::RimCell)), count, 0};
  made.mark_rims.dispatch(at.commands, constants, padded(count), shader::workgroup_size);
  vulkan::compute_barrier(at.commands);
}

} // namespace

Pass lens_search_pass(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                      const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
                      std::uint32_t surface_vectors, const StripBuffers &buffers,
                      const SceneBuffers &scene_buffers) {
  const bool fisheye = std::holds_alternative<Fisheye>(sensor.distortion);
  const auto made = std::make_shared<const LensSearch>(make_search(
      device, precision, sensor, camera, scene, blocks,
      {{shader::constant_surface_vectors, surface_vectors},
       {shader::constant_vignetting, sensor.vignetting == Vignetting::cos4},
       {shader::constant_distortion, fisheye ? shader::distortion_fisheye : shader::distortion_brown},
       {shader::constant_dark_beyond_fold, sensor.dark_beyond_fold},
       {shader::constant_cutouts, scene_buffers.paint.cutouts},
       {shader::constant_painted, scene_buffers.paint.painted}}));
  return {.name = "points",
          .reads = ids,
          .writes = ids | points,
          .record = [made, &buffers, &scene_buffers](const Recording &at) {
            mark_rims(*made, at, buffers.fragments);
            const shader::LensSearchConstants constants{
                at.of_strip(),
                made->lens.words(),
                made->views.words(at.planned.block * sizeof(shader::RasterView)),
                buffers.fragments.words(),
                scene_buffers.planes.words(),
                made->corners.words(),
                made->candidates.words(),
                buffers.ids.words(),
                buffers.position.words(),
                buffers.surface.words(),
                buffers.backscatter.words(),
                scene_buffers.paint.shapes.words(),
                scene_buffers.paint.surfaces.words()};
            made->search.dispatch(at.commands, constants, sample_count(at.of_strip()),
                                  shader::workgroup_size);
          }};
}

} // namespace pmdsim
