#include "engine/sampling/sample_grid.h"

#include "engine/lens/lens.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/sampling/strip_memory.h"
#include "engine/vulkan/float_pair.h"

namespace pmdsim {
namespace {

// A pixel's only sample lies in its middle, however much of the pixel is filled.
Sensor filled(Sensor sensor) {
  sensor.fill_factor = glm::dvec2(1.0);
  return sensor;
}

} // namespace

bool is_nominal(const Sensor &sensor) {
  return sensor.chip.is_nominal() && sensor.fill_factor == glm::dvec2(1.0);
}

shader::ChipPlace chip_place(const Sensor &sensor) {
  const glm::dmat3 lens_from_chip = Lens(sensor).lens_from_chip();
  const glm::dvec2 half_pixel_m = 0.5 * sensor.pixel_pitch_m;
  const glm::dvec2 half_step_m = half_pixel_m * sensor.fill_factor / static_cast<double>(sensor.samples);
  const DoublePair4 origin(lens_from_chip[2], 0.0), half_column(lens_from_chip[0] * half_pixel_m.x, 0.0),
      half_row(lens_from_chip[1] * half_pixel_m.y, 0.0), half_step_x(lens_from_chip[0] * half_step_m.x, 0.0),
      half_step_y(lens_from_chip[1] * half_step_m.y, 0.0);
  return {origin.hi,   origin.lo,      half_column.hi, half_column.lo, half_row.hi,
          half_row.lo, half_step_x.hi, half_step_x.lo, half_step_y.hi, half_step_y.lo};
}

shader::vec4 half_sample_slope(const Sensor &sensor) {
  const glm::dvec2 slope = sensor.pixel_pitch_m / (2.0 * sensor.samples * sensor.image_distance_m());
  return {float_pair(slope.x), float_pair(slope.y)};
}

vulkan::Buffer upload_chip(const vulkan::Device &device, const Sensor &sensor) {
  const shader::ChipPlace place = chip_place(sensor);
  return vulkan::upload(device, std::as_bytes(std::span(&place, 1)));
}

ChipGrid::ChipGrid(const vulkan::Device &device, const Sensor &sensor)
    : nominal_(sensor.chip.is_nominal()), slope_(half_sample_slope(sensor)),
      place_(chip_place(filled(sensor))), chip_(std::make_shared<const vulkan::Buffer>(
                                              vulkan::upload(device, std::as_bytes(std::span(&place_, 1))))) {
}

shader::SampleGrid ChipGrid::of(const shader::Strip &strip) const {
  const glm::dvec2 corner(glm::uvec2(strip.column, strip.row) * strip.samples);
  const glm::dvec2 all(glm::uvec2(strip.resolution_x, strip.resolution_y) * strip.samples);
  const std::uint32_t columns = strip.columns * strip.samples;
  return {slope_, glm::vec2(2.0 * corner + 1.0 - all), columns, 1.0f / static_cast<float>(columns)};
}

shader::uvec2 ChipGrid::chip() const { return chip_->words(); }

} // namespace pmdsim
