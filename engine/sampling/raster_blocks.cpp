#include "engine/sampling/raster_blocks.h"

#include "engine/lens/lens.h"

#include <algorithm>

namespace pmdsim {
namespace {

constexpr double grid = 256.0; // steps of the raster's grid a fragment

} // namespace

bool is_tiled(const Sensor &sensor) {
  return !sensor.has_distortion() && sensor.fill_factor != glm::dvec2(1.0);
}

glm::dvec2 sample_shift(const Sensor &sensor, const glm::uvec2 &subsample) {
  return is_tiled(sensor) ? ((glm::dvec2(subsample) + 0.5) / static_cast<double>(sensor.samples) - 0.5) *
                                sensor.fill_factor
                          : glm::dvec2(0.0);
}

glm::vec2 raster_shift(const Sensor &sensor, const glm::uvec2 &subsample) {
  return glm::roundEven(sample_shift(sensor, subsample) * grid) / grid;
}

std::vector<RasterBlock> chip_blocks(const Sensor &sensor, std::uint32_t block_fragments) {
  const std::uint32_t side = is_tiled(sensor) ? 1 : sensor.samples; // fragments along a pixel
  // From the chip's metres to the frame's fragments, and the depth in front of the chip's plane to metres.
  const glm::dvec2 scale = static_cast<double>(side) / sensor.pixel_pitch_m;
  const glm::dvec2 middle = 0.5 * side * glm::dvec2(sensor.resolution);
  const double depth_m = sensor.image_distance_m();
  const glm::dmat3 frame_from_chip =
      depth_m * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, middle.x, middle.y, 1);
  const glm::dmat3 frame_from_camera = frame_from_chip * glm::inverse(Lens(sensor).lens_from_chip());

  const glm::uvec2 largest(block_fragments / sensor.samples);
  const glm::uvec2 counts = (sensor.resolution + largest - 1u) / largest;
  const glm::uvec2 size = (sensor.resolution + counts - 1u) / counts;
  std::vector<RasterBlock> blocks;
  for (std::uint32_t row = 0; row < sensor.resolution.y; row += size.y)
    for (std::uint32_t column = 0; column < sensor.resolution.x; column += size.x) {
      const glm::uvec2 first(column, row), pixels = glm::min(size, sensor.resolution - first);
      const glm::dvec2 corner(first * side);
      const glm::dmat3 block_from_frame(1, 0, 0, 0, 1, 0, -corner.x, -corner.y, 1);
      blocks.push_back({first, pixels, pixels * side, block_from_frame * frame_from_camera});
    }
  return blocks;
}

std::uint32_t padded(std::uint32_t pixels) {
  return ((pixels + shader::workgroup_size - 1) / shader::workgroup_size + 1) * shader::workgroup_size;
}

std::vector<PlannedStrip> plan_strips(const Sensor &sensor, const std::vector<RasterBlock> &blocks,
                                      std::uint32_t max_samples) {
  std::vector<PlannedStrip> strips;
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    const RasterBlock &block = blocks[b];
    const std::uint32_t row_samples = block.pixels.x * sensor.samples * sensor.samples;
    const std::uint32_t rows = std::clamp(max_samples / row_samples, 1u, block.pixels.y);
    for (std::uint32_t row = 0; row < block.pixels.y; row += rows) {
      const std::uint32_t height = std::min(rows, block.pixels.y - row);
      strips.push_back(
          {{block.first_pixel.x, block.first_pixel.y + row, block.pixels.x, height, sensor.resolution.x,
            sensor.resolution.y, sensor.samples, padded(block.pixels.x * height)},
           b});
    }
  }
  return strips;
}

glm::uvec2 strip_fragments(const shader::Strip &strip, const RasterBlock &block) {
  return block.distorted ? block.fragments : glm::uvec2(strip.columns, strip.rows) * strip.samples;
}

} // namespace pmdsim
