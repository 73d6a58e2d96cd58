// A floor that reaches behind the lens and whose far edge, by the raster's snapping, covers samples that look
// along it: their rays lie in its plane and never meet it, so they see nothing of it.

#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double height_m = 1e-4, far_m = 20.0;

// `slope`: down and away, so that rays pass above its horizon.
Scene floor_below_lens(double slope) {
  const double near_y_m = height_m - 5.0 * slope, far_y_m = height_m + far_m * slope;
  SceneBuilder builder;
  builder.add_mesh({{-10, near_y_m, -5}, {10, near_y_m, -5}, {10, far_y_m, far_m}, {-10, far_y_m, far_m}},
                   {{0, 1, 2}, {0, 2, 3}});
  return builder.scene();
}

// An odd number of rows of samples, so that one of them looks along the floor; the far edge is less than half
// a step of the raster's grid below it.
Sensor level_sensor(std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {32, 33};
  sensor.pixel_pitch_m = glm::dvec2(100e-6 * samples);
  sensor.focal_length_m = 0.03;
  sensor.samples = samples;
  return sensor;
}

// A pixel has samples above, on and below the middle; only those below see the floor.
void check_middle_row(const Measurement &frame, const Sensor &sensor) {
  const std::uint32_t row = sensor.resolution.y / 2;
  for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
    const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
    INFO("column " << column);
    CHECK(frame.coverage[pixel] == (sensor.samples == 1 ? 0.0f : 1.0f / 3.0f));
    CHECK(std::isfinite(frame.returns[0].amplitude[pixel]));
    if (sensor.samples == 1)
      continue;
    CHECK(frame.range_m[pixel] > 0.9 * height_m);
    CHECK(frame.range_m[pixel] < 1.1 * far_m);
    CHECK((frame.returns[0].amplitude[pixel] > 0.0f && std::isfinite(frame.returns[0].distance_m[pixel])));
  }
}

} // namespace

TEST_CASE("samples that look along a floor see nothing of it, nor of the lens") {
  for (const double slope : {0.0, 1e-6})
    for (const std::uint32_t samples : {1u, 3u}) {
      const Sensor sensor = level_sensor(samples);
      Simulator simulator = make_simulator();
      simulator.prepare(floor_below_lens(slope), sensor, {light_at(ring(4, 0.0), 0.0, {})},
                        Backscatter::constant);
      const Measurement frame = simulator.measure();
      INFO("samples " << samples << ", slope " << slope);
      check_middle_row(frame, sensor);
    }
}
