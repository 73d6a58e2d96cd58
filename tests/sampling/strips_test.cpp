#include "engine/sampling/raster_blocks.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace pmdsim;

TEST_CASE("strips cover every pixel once, whatever their size") {
  Sensor sensor;
  for (const glm::uvec2 resolution : {glm::uvec2(640, 640), glm::uvec2(1, 1), glm::uvec2(37, 211)})
    for (const std::uint32_t samples : {1u, 3u, 16u})
      for (const std::uint32_t max_samples : {1u, 1000u, 100000u, 1u << 21}) {
        sensor.resolution = resolution;
        sensor.samples = samples;
        const auto blocks = chip_blocks(sensor, 512);
        std::vector<int> covered(sensor.pixel_count());
        for (const auto &[strip, block] : plan_strips(sensor, blocks, max_samples)) {
          CHECK(strip.padded_pixels % shader::workgroup_size == 0);
          CHECK(strip.padded_pixels >= strip.columns * strip.rows + shader::workgroup_size); // one to spare
          CHECK((strip.rows == 1 || strip.columns * strip.rows * samples * samples <= max_samples));
          CHECK(strip.columns * samples <= 512);
          for (std::uint32_t row = 0; row < strip.rows; ++row)
            for (std::uint32_t column = 0; column < strip.columns; ++column)
              ++covered[std::size_t{strip.row + row} * resolution.x + strip.column + column];
        }
        CHECK(covered == std::vector<int>(sensor.pixel_count(), 1));
      }
}
