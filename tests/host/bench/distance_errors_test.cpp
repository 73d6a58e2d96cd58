// Which pixels are compared, which lie on edges, and how far off their distances are.

#include "host/bench/distance_errors.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Two columns of four pixels see a wall, the third its edge, the fourth nothing.
struct HalfWall {
  Sensor sensor;
  Scene scene;
  std::vector<Illuminator> light;

  explicit HalfWall(std::uint32_t samples) {
    sensor.resolution = {4, 3};
    sensor.focal_length_m = 1.0;
    sensor.pixel_pitch_m = glm::dvec2(0.1);
    sensor.samples = samples;
    SceneBuilder builder;
    builder.add_triangle({0.11, -9.0, 2.0}, {0.11, 9.0, 2.0}, {-9.0, 0.0, 2.0});
    scene = builder.scene();
    scene.surfaces.front().double_sided = true;
    light = {monostatic_illuminator(sensor.world_from_camera)};
  }

  TruePixels truth(const std::vector<std::uint32_t> &pixels) const {
    return {sensor, pixels,
            reference::simulate(scene, sensor, light, Backscatter::lambert, {.pixels = pixels})};
  }

  // As a sound device would give it.
  Measurement found() const {
    const reference::Frame frame = reference::simulate(scene, sensor, light, Backscatter::lambert);
    Measurement measurement = reference::to_measurement(frame);
    measurement.sample_triangle_id = frame.sample_triangle_id;
    return measurement;
  }
};

} // namespace

TEST_CASE("random pixels are all different, ascending, and the same every time") {
  const auto pixels = random_pixels(409'600, 4096);
  CHECK(pixels.size() == 4096);
  CHECK(std::ranges::adjacent_find(pixels, std::ranges::greater_equal()) == pixels.end());
  CHECK(pixels.back() < 409'600);
  CHECK(pixels == random_pixels(409'600, 4096));
  // Evenly over the frame: each tenth of it has its share, give or take six standard deviations.
  for (std::uint32_t tenth = 0; tenth < 10; ++tenth) {
    const auto share =
        std::ranges::count_if(pixels, [&](std::uint32_t pixel) { return pixel / 40'960 == tenth; });
    CHECK(std::abs(static_cast<double>(share) - 409.6) < 6.0 * 19.2);
  }
}

TEST_CASE("a small frame is compared as a whole") {
  CHECK(random_pixels(3, 4096) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(random_pixels(3, 3) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(random_pixels(0, 5).empty());
}

TEST_CASE("edges are where the samples see several triangles, or others than the device") {
  const HalfWall wall(3);
  const std::vector<std::uint32_t> pixels{4, 5, 6, 7}; // the middle row
  const TruePixels truth = wall.truth(pixels);
  Measurement found = wall.found();
  CHECK(on_edges(truth, found, 3, 1) == std::vector{false, false, true, false});
  found.sample_triangle_id[3 * 12 + 1] = no_id; // of pixel 4
  CHECK(on_edges(truth, found, 3, 1) == std::vector{true, false, true, false});
}

TEST_CASE("edges are found with other samples than the reference's") {
  const HalfWall coarse(1), fine(4);
  CHECK(on_edges(fine.truth({4, 6, 7}), coarse.found(), 1, 1) == std::vector{false, true, false});
}

TEST_CASE("a pixel that other diodes reach lies on the edge of a shadow") {
  const HalfWall wall(2);
  TruePixels truth = wall.truth({4, 5});
  Measurement found = wall.found();
  truth.frame.lit = {1.0, 0.5};
  found.lit.assign(12, 1.0f);
  CHECK(on_edges(truth, found, 2, 2) == std::vector{false, true});
  truth.frame.lit = {1.0, 1.0 - 1e-7};
  CHECK(on_edges(truth, found, 2, 2) == std::vector{false, false});
}

TEST_CASE("errors are wrapped, apart for edges, and nothing dark counts") {
  const HalfWall wall(2);
  const TruePixels truth = wall.truth({4, 5, 6, 7});
  Measurement found = wall.found();
  auto &distance_m = found.returns[0].unrounded_distance_m;
  const double ambiguity_m = wall.sensor.ambiguity_m();
  distance_m[4] += ambiguity_m - 0.003;
  distance_m[5] += 0.001;
  distance_m[6] += 0.5;
  const ErrorsByPlace errors = distance_errors(truth, {false, false, true, false}, found);
  CHECK(errors.smooth.pixels == 2);
  CHECK(*errors.smooth.max_m == Approx(0.003).margin(1e-12));
  CHECK(*errors.smooth.rms_m == Approx(std::sqrt((9e-6 + 1e-6) / 2.0)).margin(1e-12));
  CHECK(errors.edges.pixels == 1);
  CHECK(*errors.edges.max_m == Approx(0.5).margin(1e-12));
}

TEST_CASE("no distance where the reference has one is the largest error that there is") {
  const HalfWall wall(1);
  Measurement found = wall.found();
  found.returns[0].unrounded_distance_m[4] = std::numeric_limits<double>::quiet_NaN();
  const ErrorsByPlace errors = distance_errors(wall.truth({4}), {false}, found);
  CHECK(*errors.smooth.max_m == 0.5 * wall.sensor.ambiguity_m());
  CHECK_FALSE(errors.edges.max_m);
}

TEST_CASE("distances that are rounded alone have errors, too") {
  const HalfWall wall(1);
  Measurement found = wall.found();
  found.returns[0].unrounded_distance_m.clear();
  found.returns[0].distance_m[4] += 0.001f;
  const ErrorsByPlace errors = distance_errors(wall.truth({4}), {false}, found);
  CHECK(*errors.smooth.max_m == Approx(0.001).margin(1e-6));
}
