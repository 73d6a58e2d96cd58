// Depth records change no result by what they leave out: a look-up of backscatter, and channels of ground
// truth.

#include "tests/comparison/frame_bytes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A wall that hides a triangle.
Scene hiding_wall(double reflectivity, double hidden_reflectivity) {
  SceneBuilder builder;
  builder.add_wall({4.0, {.reflectivity = reflectivity}, {-0.3, -10.0}});
  builder.add_triangle({0, 0, 5}, {0, 0.5, 5}, {0.1, 0, 5}, {.reflectivity = hidden_reflectivity});
  return builder.scene();
}

std::string bytes_of_frame(const Scene &scene, const Sensor &sensor) {
  Simulator simulator = make_simulator(keep_everything());
  simulator.prepare(scene, sensor, {diode_beside_lens(sensor, diode_at({0.1, 0, 0}))}, Backscatter::lambert);
  return bytes_of(simulator.measure());
}

Measurement measured(const RepeatabilityFrame &frame, SamplePrecision precision, bool depth_records) {
  Simulator simulator =
      make_simulator({.device = {}, .precision = precision, .allowed = {.depth_records = depth_records}});
  return measure(simulator, frame);
}

} // namespace

TEST_CASE("one backscatter gives the same bits whether it is looked up or not") {
  Sensor sensor;
  sensor.resolution = {64, 48};
  sensor.pixel_pitch_m = glm::dvec2(4e-4);
  sensor.focal_length_m = 0.02;
  sensor.samples = GENERATE(1u, 2u);
  sensor.vignetting = GENERATE(Vignetting::none, Vignetting::cos4);
  const double reflectivity = GENERATE(0.7, 0.0);
  CHECK((bytes_of_frame(hiding_wall(reflectivity, reflectivity), sensor) ==
         bytes_of_frame(hiding_wall(reflectivity, 0.3), sensor)));
}

TEST_CASE("ground truth is the same whether it is read off records or comes in channels") {
  const auto precision = GENERATE(SamplePrecision::automatic, SamplePrecision::double_float);
  const RepeatabilityFrame frame = repeatability_frame("records_without_gaps");
  const Measurement records = measured(frame, precision, true), channels = measured(frame, precision, false);
  const auto same = [](const std::vector<float> &a, const std::vector<float> &b) {
    return std::ranges::equal(a, b, [](float x, float y) { return x == y || (x != x && y != y); });
  };
  const auto hits = std::ranges::count(records.coverage, 1.0f);
  REQUIRE(hits > 10000);
  REQUIRE(hits < static_cast<std::ptrdiff_t>(frame.sensor.pixel_count()));
  CHECK(same(records.coverage, channels.coverage));
  CHECK(same(records.z_m, channels.z_m));
  CHECK(same(records.range_m, channels.range_m));
  CHECK((records.triangle_id == channels.triangle_id));
  CHECK((records.object_id == channels.object_id));
}
