// Lights that nobody thought of: several illuminators with phases, orders and measured diagrams mixed, any
// waveform; the device against the reference.

#include "tests/comparison/comparison.h"
#include "tests/comparison/grazing_light.h"
#include "tests/comparison/random_options.h"
#include "tests/support/random_diagrams.h"
#include "tests/support/random_scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Illuminator with_diagrams(Random &random, Illuminator illuminator, bool all) {
  const auto diagram = random_diagram(random, random.flip());
  for (Diode &diode : illuminator.diodes) {
    const glm::dvec3 aside = std::abs(diode.axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    diode.across = glm::normalize(glm::cross(diode.axis, aside));
    if (all || random.flip())
      diode.pattern = {Pattern::Kind::diagram, 0.0, diagram};
  }
  return illuminator;
}

std::vector<Illuminator> random_lights(Random &random, std::uint32_t seed, const Pose &world_from_camera) {
  std::vector<Illuminator> lights;
  for (std::uint32_t i = 0; i < 1 + seed % 3; ++i) {
    const Pose place{glm::dmat3(1.0), random.in_box(glm::dvec3(-0.5), glm::dvec3(0.5, 0.5, 0.2))};
    lights.push_back(with_diagrams(
        random, random_illuminator(random, 1 + 5 * (seed % 4), compose(world_from_camera, place)),
        random.flip()));
    lights.back().modulation_phase_rad = random.flip() ? 0.0 : random.uniform(-1.0, 1.0);
  }
  return lights;
}

Sensor sensor_for(Random &random, std::uint32_t seed) {
  Sensor sensor;
  sensor.resolution = {72, 48};
  sensor.pixel_pitch_m = {1e-3, 1.2e-3};
  sensor.focal_length_m = 0.1;
  sensor.world_from_camera = random.pose(30.0);
  sensor.modulation_hz = {random.uniform(10e6, 40e6)};
  if (seed % 3 == 1)
    sensor.waveform = {Waveform::Kind::square, {}};
  if (seed % 3 == 2)
    sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, -0.1}};
  return sensor;
}

// Where the illuminators' returns cancel to less than half, what is left is known that much worse.
std::vector<bool> where_returns_cancel(const reference::Frame &frame, const Scene &scene,
                                       const Sensor &sensor, const std::vector<Illuminator> &lights,
                                       Backscatter backscatter) {
  std::vector<double> together(sensor.pixel_count(), 0.0);
  for (const Illuminator &light : lights) {
    const auto alone = reference::simulate(scene, sensor, {light}, backscatter);
    for (std::size_t i = 0; i < together.size(); ++i)
      together[i] += alone.returns[0].amplitude[i];
  }
  std::vector<bool> cancel(sensor.pixel_count());
  for (std::size_t i = 0; i < cancel.size(); ++i)
    cancel[i] = frame.returns[0].amplitude[i] < 0.5 * together[i];
  return cancel;
}

// Near an end of a diagram or a diode's horizon light ends abruptly.
std::vector<bool> in_grazing_light(const reference::Frame &frame, const Scene &scene, const Sensor &sensor,
                                   const std::vector<Illuminator> &lights, std::vector<bool> grazing) {
  for (const Illuminator &light : lights) {
    const std::vector<bool> of_light = pixels_in_grazing_light(frame, scene, sensor, light);
    for (std::size_t i = 0; i < grazing.size(); ++i)
      grazing[i] = grazing[i] || of_light[i];
  }
  return grazing;
}

void check_random_lights(std::uint32_t first, std::uint32_t last) {
  fmt::print("{}", comparison_heading());
  for (std::uint32_t seed = first; seed < last; ++seed) {
    Random random(seed);
    const Sensor sensor = sensor_for(random, seed);
    const Scene scene = random_triangles(random, 60, sensor.world_from_camera);
    const std::vector<Illuminator> lights = random_lights(random, seed, sensor.world_from_camera);
    const Backscatter backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
    const auto expected = reference::simulate(scene, sensor, lights, backscatter);
    Simulator simulator = make_simulator(random_options(random));
    // A table is as exact as float in either precision.
    const Accuracy accuracy{.precision = seed % 2 == 0 ? Precision::fp32 : Precision::fp64};
    simulator.prepare(scene, sensor, lights, backscatter, Shadows::off, accuracy);
    const std::vector<bool> left_out = in_grazing_light(
        expected, scene, sensor, lights, where_returns_cancel(expected, scene, sensor, lights, backscatter));
    const Comparison comparison = compare(simulator.measure(), expected, scene, sensor, left_out);
    fmt::print("{}", comparison_row(fmt::format("seed {}, {} illuminators, {} diodes", seed, lights.size(),
                                                diode_count(lights)),
                                    comparison));
    INFO("seed " << seed);
    CHECK(comparison.pixels >= sensor.pixel_count() / 10);
    CHECK(comparison.distance_max_m <= 2e-6);
    CHECK(comparison.distance_rms_m <= 0.3e-6);
    CHECK(comparison.amplitude_max_relative <= 1e-4); // tabulated
    CHECK(comparison.disagreements == 0);
  }
}

} // namespace

TEST_CASE("some random lights agree with the reference", "[smoke]") { check_random_lights(500, 504); }

TEST_CASE("random lights agree with the reference", "[long]") { check_random_lights(500, 518); }
