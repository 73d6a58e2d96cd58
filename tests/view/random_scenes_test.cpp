// Scenes, lights, poses and cameras that nobody thought of: random, with seeds that never change.

#include "engine/lens/lens.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/grazing_light.h"
#include "tests/comparison/random_options.h"
#include "tests/support/random_cameras.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <array>
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
  options.keep_sample_ids = true;
  options.precision = seed % 2 == 0 ? SamplePrecision::automatic : SamplePrecision::double_float;
  options.loop = seed % 4 < 2 ? DiodeLoop::straight_line : DiodeLoop::looped;
  return options;
}

using Corners = std::array<glm::dvec3, 3>;

bool pierces(const glm::dvec3 &from_m, const glm::dvec3 &to_m, const Corners &triangle) {
  const auto &[a, b, c] = triangle;
  const glm::dvec3 normal = glm::cross(b - a, c - a), along = to_m - from_m;
  if ((glm::dot(normal, from_m - a) > 0) == (glm::dot(normal, to_m - a) > 0))
    return false;
  const auto side = [&](const glm::dvec3 &p, const glm::dvec3 &q) {
    return glm::dot(along, glm::cross(p - from_m, q - from_m)) > 0;
  };
  return side(a, b) == side(b, c) && side(b, c) == side(c, a);
}

// Where triangles cut through each other the raster's grid moves the line along which they do, which no edge
// marks.
bool cut_through_each_other(const Corners &one, const Corners &other) {
  for (std::size_t k = 0; k < 3; ++k)
    if (pierces(one[k], one[(k + 1) % 3], other) || pierces(other[k], other[(k + 1) % 3], one))
      return true;
  return false;
}

// A triangle of 0.1 to 1 m, somewhere in the view.
Corners triangle_in_view(Random &random, const Sensor &sensor) {
  const Lens lens(sensor);
  const double column = random.uniform(0, sensor.resolution.x), row = random.uniform(0, sensor.resolution.y);
  const glm::dvec3 centre_m = random.uniform(1.3, 2.5) * *lens.ray(lens.on_chip_m({column, row}));
  const double size_m = random.uniform(0.1, 0.5);
  Corners corners_m;
  for (glm::dvec3 &corner_m : corners_m)
    corner_m = centre_m + size_m * random.unit_vector();
  return corners_m;
}

Scene triangles_in_view(Random &random, std::size_t count, const Sensor &sensor) {
  SceneBuilder builder(sensor.world_from_camera);
  std::vector<Corners> triangles;
  while (triangles.size() < count) {
    const Corners triangle = triangle_in_view(random, sensor);
    if (std::ranges::any_of(triangles,
                            [&](const Corners &other) { return cut_through_each_other(triangle, other); }))
      continue;
    triangles.push_back(triangle);
    const double reflectivity = random.uniform(0.1, 1.0);
    builder.add_triangle(triangle[0], triangle[1], triangle[2], {reflectivity, random.flip()});
  }
  return builder.scene();
}

Waveform random_waveform(Random &random) {
  const double kind = random.uniform(0, 3);
  if (kind < 1)
    return {Waveform::Kind::sine, {}};
  if (kind < 2)
    return {Waveform::Kind::square, {}};
  Waveform waveform{Waveform::Kind::harmonics, {1.0}};
  const auto more = static_cast<int>(random.uniform(0, 5));
  for (int h = 0; h < more; ++h)
    waveform.harmonics.push_back(random.uniform(-0.3, 0.3));
  return waveform;
}

Sensor random_sensor(Random &random, std::uint32_t seed) {
  Sensor sensor;
  do
    sensor = random_camera(random, {96 + seed % 5, 64 + seed % 3});
  while (lens_fault(sensor));
  sensor.samples = 1 + seed % 3;
  sensor.world_from_camera = random.pose(100.0);
  sensor.waveform = random_waveform(random);
  sensor.taps = static_cast<std::uint32_t>(random.uniform(3, 17));
  sensor.modulation_hz.clear();
  const auto frequencies = static_cast<int>(random.uniform(1, 4));
  for (int f = 0; f < frequencies; ++f)
    sensor.modulation_hz.push_back(random.uniform(5e6, 50e6));
  return sensor;
}

SimulatorOptions options_in_strips(Random &random) {
  SimulatorOptions options = random_options(random);
  options.max_strip_samples = random.flip() ? 0 : static_cast<std::uint32_t>(random.uniform(1, 20'000));
  return options;
}

std::string described(const Sensor &sensor) {
  constexpr std::array distortions{"pinhole", "Brown", "fisheye"};
  constexpr std::array waveforms{"sine", "square", "harmonics"};
  return fmt::format("{}, {}, N = {}, S = {}", distortions[sensor.distortion.index()],
                     waveforms[static_cast<std::size_t>(sensor.waveform.kind)], sensor.taps, sensor.samples);
}

void check_random_scenes(std::uint32_t first, std::uint32_t last) {
  fmt::print("{}", comparison_heading());
  for (std::uint32_t seed = first; seed < last; ++seed) {
    const auto [sensor, scene, illuminator, backscatter] = random_setup(seed);
    const auto expected = reference::simulate(scene, sensor, {illuminator}, backscatter);
    Simulator simulator = make_simulator(options_for(seed));
    simulator.prepare(scene, sensor, {illuminator}, backscatter);
    const Comparison comparison = compare(simulator.measure(), expected, scene, sensor,
                                          pixels_in_grazing_light(expected, scene, sensor, illuminator));
    fmt::print("{}", comparison_row(fmt::format("seed {}, S = {}", seed, sensor.samples), comparison));
    INFO("seed " << seed);
    check_comparison(comparison, sensor.pixel_count() / 10);
  }
}

} // namespace

TEST_CASE("some random scenes agree with the reference", "[smoke]") { check_random_scenes(0, 4); }

TEST_CASE("random scenes agree with the reference", "[long]") { check_random_scenes(0, 24); }

// With distortion no raster snaps: samples and reference see another triangle only where rounding decides.
// Pixels are few, so that the share of such samples is counted over all cameras.
namespace {

void check_random_cameras(std::uint32_t first, std::uint32_t last) {
  Comparison distorted;
  fmt::print("{}", comparison_heading());
  for (std::uint32_t seed = first; seed < last; ++seed) {
    Random random(seed);
    const Sensor sensor = random_sensor(random, seed);
    const Scene scene = triangles_in_view(random, 40 + 10 * (seed % 12), sensor);
    const Illuminator illuminator = random_illuminator(random, 1 + 7 * (seed % 6), sensor.world_from_camera);
    const Backscatter backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
    const auto expected = reference::simulate(scene, sensor, {illuminator}, backscatter);
    Simulator simulator = make_simulator(options_in_strips(random));
    simulator.prepare(scene, sensor, {illuminator}, backscatter);
    const Comparison comparison = compare(simulator.measure(), expected, scene, sensor,
                                          pixels_in_grazing_light(expected, scene, sensor, illuminator));
    fmt::print("{}", comparison_row(fmt::format("{}: {}", seed, described(sensor)), comparison));
    INFO("seed " << seed);
    check_comparison(comparison, sensor.pixel_count() / 10);
    if (sensor.has_distortion()) {
      distorted.samples += comparison.samples;
      distorted.differing_samples += comparison.differing_samples;
    }
  }
  fmt::print("of all cameras with distortion, {:.5f} % of the samples see another triangle\n",
             100 * distorted.differing_fraction());
  CHECK(distorted.differing_fraction() <= 1e-5);
}

} // namespace

TEST_CASE("some random cameras and signals agree with the reference") { check_random_cameras(100, 105); }

TEST_CASE("random cameras and signals agree with the reference", "[long]") { check_random_cameras(100, 124); }
