// The samples' places on the chip as the shaders add them up, against eq. 1 (docs/theory.md,
// "Conventions").

#include "engine/sampling/sample_grid.h"

#include "engine/lens/lens.h"
#include "tests/support/random_cameras.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

glm::dvec3 sum(const glm::vec4 &hi, const glm::vec4 &lo) { return glm::dvec3(hi) + glm::dvec3(lo); }

// As shaders/shared/interface.h says of ChipPlace.
glm::dvec3 place_m(const shader::ChipPlace &chip, const Sensor &sensor, const glm::ivec2 &pixel,
                   const glm::ivec2 &subsample) {
  const glm::dvec2 from_middle(2 * pixel + 1 - glm::ivec2(sensor.resolution));
  const glm::dvec2 from_centre(2 * subsample + 1 - static_cast<int>(sensor.samples));
  return sum(chip.origin_hi, chip.origin_lo) + from_middle.x * sum(chip.half_column_hi, chip.half_column_lo) +
         from_middle.y * sum(chip.half_row_hi, chip.half_row_lo) +
         from_centre.x * sum(chip.half_step_x_hi, chip.half_step_x_lo) +
         from_centre.y * sum(chip.half_step_y_hi, chip.half_step_y_lo);
}

} // namespace

TEST_CASE("every sample's place on any chip is where eq. 1 puts it") {
  Random random(21);
  for (int i = 0; i < 50; ++i) {
    Sensor sensor = random_camera(random, {60, 40});
    sensor.samples = 1 + static_cast<std::uint32_t>(i % 4);
    const shader::ChipPlace chip = chip_place(sensor);
    const Lens lens(sensor);
    for (const glm::ivec2 pixel : {glm::ivec2(0, 0), glm::ivec2(59, 39), glm::ivec2(17, 3)})
      for (int k = 0; k < static_cast<int>(sensor.samples); ++k) {
        const glm::ivec2 subsample(k, static_cast<int>(sensor.samples) - 1 - k);
        const glm::dvec2 from_centre =
            ((glm::dvec2(subsample) + 0.5) / double(sensor.samples) - 0.5) * sensor.fill_factor;
        const glm::dvec2 chip_m = lens.on_chip_m(glm::dvec2(pixel) + 0.5 + from_centre);
        const glm::dvec3 expected_m = lens.lens_from_chip() * glm::dvec3(chip_m, 1.0);
        REQUIRE(glm::distance(place_m(chip, sensor, pixel, subsample), expected_m) <
                1e-12 * glm::length(expected_m));
      }
  }
}

TEST_CASE("only an upright chip in its place, filled wholly, is plain") {
  Sensor sensor;
  CHECK(is_nominal(sensor));
  sensor.fill_factor.y = 0.5;
  CHECK_FALSE(is_nominal(sensor));
  sensor.fill_factor.y = 1.0;
  sensor.chip.rotation_rad.z = 1e-9;
  CHECK_FALSE(is_nominal(sensor));
  sensor.chip = {};
  sensor.chip.translation_m.x = 1e-9;
  CHECK_FALSE(is_nominal(sensor));
}
