#include "engine/sampling/chip_grid.h"

#include "engine/sampling/chip_place.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/sampling/strip_memory.h"

namespace pmdsim {
namespace {

// A pixel's only sample lies in its middle, however much of the pixel is filled.
Sensor filled(Sensor sensor) {
  sensor.fill_factor = glm::dvec2(1.0);
  return sensor;
}

} // namespace

ChipGrid::ChipGrid(const vulkan::Device &device, const Sensor &sensor)
    : nominal_(sensor.chip.is_nominal()), slope_(half_sample_slope(sensor)),
      chip_(std::make_shared<const vulkan::Buffer>(upload_chip(device, filled(sensor)))) {}

shader::SampleGrid ChipGrid::of(const shader::Strip &strip) const {
  const glm::dvec2 corner(glm::uvec2(strip.column, strip.row) * strip.samples);
  const glm::dvec2 all(glm::uvec2(strip.resolution_x, strip.resolution_y) * strip.samples);
  const std::uint32_t columns = strip.columns * strip.samples;
  return {slope_, glm::vec2(2.0 * corner + 1.0 - all), columns, 1.0f / static_cast<float>(columns)};
}

shader::uvec2 ChipGrid::chip() const { return chip_->words(); }

} // namespace pmdsim
