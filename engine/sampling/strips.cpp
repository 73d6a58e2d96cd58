#include "engine/sampling/strips.h"

#include <algorithm>

namespace pmdsim {

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
