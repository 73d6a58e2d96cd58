// Textures, vertex colours, alpha masks and points, at random: the device against the reference.

#include "engine/lens/lens.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/grazing_light.h"
#include "tests/support/painted_scenes.h"
#include "tests/support/random_cameras.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Sensor camera_of_any_kind(Random &random, std::uint32_t seed) {
  Sensor sensor;
  do
    sensor = random_camera(random, {90 + seed % 7, 70 + seed % 3});
  while (lens_fault(sensor) || (seed % 3 != 0 && sensor.has_distortion()));
  sensor.samples = 1 + seed % 3;
  sensor.world_from_camera = random.pose(30.0);
  return sensor;
}

SimulatorOptions options_for(Random &random) {
  SimulatorOptions options;
  options.keep_sample_ids = true;
  options.precision = random.flip() ? SamplePrecision::automatic : SamplePrecision::double_float;
  options.max_strip_samples = random.flip() ? 0 : static_cast<std::uint32_t>(random.uniform(1, 20'000));
  return options;
}

void check_random_paint(std::uint32_t first, std::uint32_t last) {
  fmt::print("{}", comparison_heading());
  Comparison distorted;
  for (std::uint32_t seed = first; seed < last; ++seed) {
    Random random(seed);
    const Sensor sensor = camera_of_any_kind(random, seed);
    Scene scene = random_triangles(random, 60, sensor.world_from_camera);
    if (seed % 4 != 1)
      paint(random, scene);
    if (seed % 4 != 2)
      scatter_discs(random, 300, sensor.world_from_camera, scene);
    const Illuminator light = random_illuminator(random, 9, sensor.world_from_camera);
    const Backscatter backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
    const auto expected = reference::simulate(scene, sensor, {light}, backscatter);
    Simulator simulator = make_simulator(options_for(random));
    simulator.prepare(scene, sensor, {light}, backscatter);
    const Comparison comparison = compare(simulator.measure(), expected, scene, sensor,
                                          pixels_in_grazing_light(expected, scene, sensor, light));
    fmt::print("{}", comparison_row(fmt::format("{}: S = {}{}", seed, sensor.samples,
                                                sensor.has_distortion() ? ", distorted" : ""),
                                    comparison));
    INFO("seed " << seed);
    check_comparison(comparison, sensor.pixel_count() / (sensor.has_distortion() ? 20 : 10));
    if (sensor.has_distortion()) {
      distorted.samples += comparison.samples;
      distorted.differing_samples += comparison.differing_samples;
    }
  }
  fmt::print("of all cameras with distortion, {:.5f} % of the samples see another shape\n",
             100 * distorted.differing_fraction());
  CHECK(distorted.differing_fraction() <= 1e-5);
}

} // namespace

TEST_CASE("some random paint and points agree with the reference") { check_random_paint(300, 304); }

TEST_CASE("random paint and points agree with the reference", "[long]") { check_random_paint(300, 318); }

TEST_CASE("an alpha that equals its cutoff is no hole") {
  SceneBuilder builder;
  Paint paint;
  paint.reflectivity_rgb = glm::dvec3(0.3);
  paint.alpha_cutoff = 0.7; // which no float is
  builder.add_wall({2.0, {0.0, true, paint}, {-10.0, -7.0}, {9.0, 10.0}});
  Scene scene = builder.scene();
  scene.colours.assign(scene.positions_m.size(), glm::vec4(1.0f, 1.0f, 1.0f, 0.7f));
  Sensor sensor;
  sensor.resolution = {32, 32};
  const std::vector<Illuminator> light{monostatic_illuminator(sensor.world_from_camera)};
  const auto expected = reference::simulate(scene, sensor, light, Backscatter::lambert);
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true});
  simulator.prepare(scene, sensor, light, Backscatter::lambert);
  const Comparison comparison = compare(simulator.measure(), expected, scene, sensor);
  CHECK(comparison.pixels == sensor.pixel_count());
  CHECK(comparison.differing_samples == 0);
}
