// Without distortion the fragments are the samples: each carries the pixel that it is a sample of.

#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/support/units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Sensor sensor_of(std::uint32_t samples, const glm::dvec2 &fill_factor, const glm::dvec3 &rotation_rad) {
  Sensor sensor;
  sensor.resolution = {13, 11};
  sensor.pixel_pitch_m = {1.1e-3, 1e-3};
  sensor.focal_length_m = 0.02;
  sensor.samples = samples;
  sensor.fill_factor = fill_factor;
  sensor.chip.rotation_rad = rotation_rad;
  return sensor;
}

// Samples whose tag is not that of the pixel they belong to, or not 0 where they see nothing.
std::size_t wrong_tags(const Measurement &measured, const Sensor &sensor) {
  const glm::uvec2 samples = sensor.resolution * sensor.samples;
  REQUIRE(measured.sample_pixel_id.size() == std::size_t{samples.x} * samples.y);
  std::size_t wrong = 0;
  for (glm::uvec2 sample(0); sample.y < samples.y; ++sample.y)
    for (sample.x = 0; sample.x < samples.x; ++sample.x) {
      const std::size_t at = std::size_t{sample.y} * samples.x + sample.x;
      const glm::uvec2 pixel = sample / sensor.samples;
      const bool seen = measured.sample_triangle_id[at] != no_id;
      wrong += measured.sample_pixel_id[at] != (seen ? pixel.y * sensor.resolution.x + pixel.x + 1 : 0);
    }
  return wrong;
}

Simulator tagging_simulator(std::uint32_t max_strip_samples) {
  return make_simulator({.device = {}, .max_strip_samples = max_strip_samples, .keep_sample_ids = true});
}

Measurement measure_tags(Simulator &simulator, const Scene &scene, const Sensor &sensor) {
  simulator.prepare(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  return simulator.measure();
}

std::size_t samples_seen(const Measurement &measured) {
  return static_cast<std::size_t>(std::count_if(measured.sample_pixel_id.begin(),
                                                measured.sample_pixel_id.end(),
                                                [](std::uint32_t id) { return id != 0; }));
}

} // namespace

TEST_CASE("every sample carries its pixel") {
  const std::uint32_t samples = GENERATE(1u, 2u, 3u);
  const glm::dvec2 fill_factor = GENERATE(glm::dvec2(1), glm::dvec2(0.6, 0.4));
  const glm::dvec3 rotation_rad = GENERATE(glm::dvec3(0), glm::dvec3(15, -10, 20) * degree);
  const Sensor sensor = sensor_of(samples, fill_factor, rotation_rad);
  const std::uint32_t row_samples = sensor.resolution.x * samples * samples;
  SceneBuilder half;
  half.add_wall({2, {}, {-10, -10}, {0.123, 10}});
  for (const std::uint32_t rows : {0u, 1u, 4u}) {
    INFO(fmt::format("S = {}, fill {} x {}, tilted {}, strips of {} rows", samples, fill_factor.x,
                     fill_factor.y, rotation_rad != glm::dvec3(0), rows));
    Simulator simulator = tagging_simulator(rows * row_samples);
    const Measurement full = measure_tags(simulator, wall_at(2), sensor);
    CHECK(samples_seen(full) == full.sample_pixel_id.size());
    CHECK(wrong_tags(full, sensor) == 0);
    const Measurement partly = measure_tags(simulator, half.scene(), sensor);
    CHECK(samples_seen(partly) > full.sample_pixel_id.size() / 3);
    CHECK(samples_seen(partly) < full.sample_pixel_id.size() * 2 / 3);
    CHECK(wrong_tags(partly, sensor) == 0);
  }
}

TEST_CASE("under distortion, too, every sample that sees something carries its pixel") {
  Sensor sensor = sensor_of(2, {0.6, 0.4}, glm::dvec3(0));
  sensor.distortion = BrownConrady{-0.3, 0, 0, 0, 0};
  Simulator simulator = tagging_simulator(0);
  const Measurement full = measure_tags(simulator, wall_at(2), sensor);
  CHECK(samples_seen(full) == full.sample_pixel_id.size());
  CHECK(wrong_tags(full, sensor) == 0);
}
