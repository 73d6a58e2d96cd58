// Scenes, lights and poses that nobody thought of: random, with seeds that never change.

#include "tests/gpu_against_reference/comparison.h"
#include "tests/gpu_against_reference/grazing_light.h"
#include "tests/support/random_scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct RandomSetup {
  Sensor sensor;
  Scene scene;
  Illuminator illuminator;
  Backscatter backscatter;
};

RandomSetup random_setup(std::uint32_t seed) {
  Random random(seed);
  RandomSetup setup;
  setup.sensor.resolution = {96 + seed % 5, 64 + seed % 3};
  setup.sensor.pixel_pitch_m = {1e-3, 1.2e-3};
  setup.sensor.focal_length_m = 0.1;
  setup.sensor.samples = 1 + seed % 3;
  setup.sensor.world_from_camera = random.pose(100.0);
  setup.scene = random_triangles(random, 40 + 10 * (seed % 12), setup.sensor.world_from_camera);
  setup.backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
  const Pose beside_lens{glm::dmat3(1.0), random.in_box(glm::dvec3(-0.1), glm::dvec3(0.1))};
  setup.illuminator =
      random_illuminator(random, 1 + 7 * (seed % 6), compose(setup.sensor.world_from_camera, beside_lens));
  return setup;
}

// Every combination of the arithmetic that devices of different kinds are given.
SimulatorOptions options_for(std::uint32_t seed) {
  SimulatorOptions options;
  options.keep_sample_tags = true;
  options.precision = seed % 2 == 0 ? SamplePrecision::automatic : SamplePrecision::double_float;
  options.loop = seed % 4 < 2 ? DiodeLoop::straight_line : DiodeLoop::looped;
  return options;
}

} // namespace

TEST_CASE("random scenes agree with the reference") {
  fmt::print("{}", comparison_heading());
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    const auto [sensor, scene, illuminator, backscatter] = random_setup(seed);
    const auto expected = reference::simulate(scene, sensor, illuminator, backscatter);
    Simulator simulator = make_simulator(options_for(seed));
    simulator.prepare(scene, sensor, illuminator, backscatter);
    const Comparison comparison = compare(simulator.measure(), expected, scene, sensor,
                                          pixels_in_grazing_light(expected, scene, sensor, illuminator));
    fmt::print("{}", comparison_row(fmt::format("seed {}, S = {}", seed, sensor.samples), comparison));
    INFO("seed " << seed);
    check_comparison(comparison, sensor.pixel_count() / 10);
  }
}
