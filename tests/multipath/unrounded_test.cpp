// Distances with light that bounces, before they are rounded.

#include "tests/comparison/frame_bytes.h"
#include "tests/multipath/frames.h"
#include "tests/reference/bounce_fixture.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("unrounded distances with bounces are those without, and what bounces add") {
  const Sensor sensor = wide_sensor({24, 24}, 1.2);
  const Scene scene = scene_of(corner_of_plates());
  const Illuminator light{"lamp", sensor.world_from_camera, {diode_at({0.2, 0.1, 0.3})}};
  SimulatorOptions options;
  const Measurement rounded = bounced_frame(scene, sensor, {light}, {1, 1e-3}, options);
  options.keep_unrounded = true;
  const Measurement frame = bounced_frame(scene, sensor, {light}, {1, 1e-3}, options);
  CHECK((bytes_of(frame) == bytes_of(rounded)));
  CHECK(rounded.returns[0].unrounded_direct_distance_m.empty());
  const Return &of = frame.returns[0];
  std::size_t bounced = 0;
  for (std::size_t i = 0; i < of.distance_m.size(); ++i) {
    const double whole_m = of.unrounded_distance_m[i], direct_m = of.unrounded_direct_distance_m[i];
    const double multipath_m = static_cast<double>(of.multipath_m[i]);
    INFO(i << ": " << whole_m << ", " << direct_m << ", " << multipath_m);
    REQUIRE(std::isnan(whole_m) == std::isnan(of.distance_m[i]));
    if (std::isnan(multipath_m))
      continue;
    bounced += multipath_m > 1e-3 ? 1u : 0u;
    REQUIRE(std::abs(whole_m - direct_m - multipath_m) <= 1e-7 * std::abs(multipath_m) + 1e-14);
    REQUIRE(std::abs(whole_m - static_cast<double>(of.distance_m[i])) <= 1e-6);
    REQUIRE(std::abs(direct_m - static_cast<double>(of.direct_distance_m[i])) <= 3e-7);
  }
  CHECK(bounced > 100);
}
