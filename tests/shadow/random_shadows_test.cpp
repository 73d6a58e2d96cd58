// Which diodes light which point, on the Vulkan device against the reference, pair by pair.

#include "engine/lens/lens.h"
#include "host/input/setup/setup.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/grazing_light.h"
#include "tests/comparison/variants.h"
#include "tests/comparison/visibility_comparison.h"
#include "tests/support/random_cameras.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/shadow_setups.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr reference::Options reference_options{Shadows::automatic, true};

SimulatorOptions options_of(const Variant &variant) {
  return {.device = {},
          .keep_sample_ids = true,
          .keep_visibility = true,
          .precision = variant.precision,
          .loop = variant.loop,
          // The second variant does all as a GPU does.
          .allowed = {.host_sweep = variant.precision != SamplePrecision::double_float}};
}

Setup shipped(const std::string &name) { return load_setup(PMDSIM_SCENES "/" + name + ".json"); }

void check_reached(const ReachedComparison &comparison) {
  CHECK(comparison.differing_fraction() <= 1e-4);
  CHECK(comparison.clear_of_edges == 0);
  CHECK(comparison.lit_error <= 1e-6);
}

void check_scene(const std::string &name, const Setup &setup, const Variant &variant,
                 const reference::Frame &expected) {
  INFO(name);
  const auto &[scene, sensors, illuminators, others] = setup.start;
  Simulator simulator = make_simulator(options_of(variant));
  simulator.prepare(scene, sensors[0], illuminators, setup.backscatter, Shadows::automatic);
  const Measurement measured = simulator.measure();
  const ReachedComparison reached = compare_reached(measured, expected, scene, sensors[0], illuminators);
  const Comparison light = compare(measured, expected, scene, sensors[0], reached.differing_pixels);
  const double agreeing = share_of_pixels_agreeing(measured, expected);
  fmt::print("{}{}", reached_heading(), reached_row(name, reached));
  fmt::print("{}{}", comparison_heading(), comparison_row(name, light));
  fmt::print("{:.4f} % of the pixels agree to 3 micrometres\n\n", 100 * agreeing);
  check_reached(reached);
  check_comparison(light, sensors[0].pixel_count() / 2);
  CHECK(agreeing >= 0.995);
}

// Everything but what only one of the two has.
void check_same_light(const Measurement &measured, const Measurement &expected) {
  REQUIRE(measured.returns.size() == expected.returns.size());
  for (std::size_t f = 0; f < expected.returns.size(); ++f) {
    CHECK(measured.returns[f].amplitude == expected.returns[f].amplitude);
    CHECK(measured.returns[f].phase_rad == expected.returns[f].phase_rad);
    CHECK(measured.returns[f].distance_m == expected.returns[f].distance_m);
  }
  CHECK(measured.range_m == expected.range_m);
  CHECK(measured.sample_triangle_id == expected.sample_triangle_id);
}

bool all_one(const std::vector<float> &values) {
  return !values.empty() && std::ranges::all_of(values, [](float value) { return value == 1; });
}

Sensor random_sensor(Random &random, std::uint32_t seed) {
  Sensor sensor;
  do
    sensor = random_camera(random, {64, 48});
  while (lens_fault(sensor));
  sensor.samples = 1 + seed % 3;
  sensor.world_from_camera = random.pose(30.0);
  sensor.modulation_hz = {20e6, random.uniform(5e6, 50e6)};
  if (seed % 3 == 0)
    sensor.waveform = {Waveform::Kind::square, {}};
  if (seed % 3 == 1)
    sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, -0.1}};
  sensor.taps = 4 + seed % 2;
  return sensor;
}

SimulatorOptions random_options(Random &random) {
  SimulatorOptions options = options_of(variants[random.flip() ? 0 : 1]);
  options.keep_taps = true;
  options.allowed.polynomial_moments = random.flip();
  options.allowed.host_sweep = random.flip();
  options.max_strip_samples = random.flip() ? 0 : static_cast<std::uint32_t>(random.uniform(1, 9'000));
  return options;
}

// Where light grazes, and where the two do not agree on which diodes reach.
std::vector<bool> not_comparable(const ReachedComparison &reached, std::vector<bool> grazing) {
  for (std::size_t pixel = 0; pixel < grazing.size(); ++pixel)
    grazing[pixel] = grazing[pixel] || reached.differing_pixels[pixel];
  return grazing;
}

void check_shipped(const std::vector<std::string> &names) {
  for (const std::string &name : names) {
    const Setup setup = shipped(name);
    const auto &[scene, sensors, illuminators, others] = setup.start;
    const auto expected =
        reference::simulate(scene, sensors[0], illuminators, setup.backscatter, reference_options);
    for (const Variant &variant : variants)
      check_scene(name + variant.name, setup, variant, expected);
  }
}

void check_random_shadows(std::uint32_t first, std::uint32_t last) {
  ReachedComparison all;
  std::vector<Simulator> simulators;
  for (const Variant &variant : variants)
    simulators.push_back(make_simulator(options_of(variant)));
  for (std::uint32_t seed = first; seed < last; ++seed) {
    INFO("seed " << seed);
    const auto [scene, sensor, illuminators] = random_shadow_setup(seed);
    const auto expected =
        reference::simulate(scene, sensor, illuminators, Backscatter::lambert, reference_options);
    Simulator &simulator = simulators[seed % 2];
    simulator.prepare(scene, sensor, illuminators, Backscatter::lambert, Shadows::automatic);
    const ReachedComparison reached =
        compare_reached(simulator.measure(), expected, scene, sensor, illuminators);
    CHECK(reached.clear_of_all == 0);
    CHECK(reached.lit_error <= 1e-6);
    all.samples += reached.samples;
    all.pairs += reached.pairs;
    all.reached += reached.reached;
    all.differing_pairs += reached.differing_pairs;
    all.clear_of_edges += reached.clear_of_edges;
    all.clear_of_all += reached.clear_of_all;
  }
  fmt::print("{}{}", reached_heading(), reached_row(fmt::format("{} random scenes", last - first), all));
  CHECK(all.pairs > 5'000 * (last - first));
  CHECK(all.differing_fraction() <= 1e-4);
}

} // namespace

TEST_CASE("shadows in a shipped scene agree with the reference", "[long]") { check_shipped({"bars"}); }

TEST_CASE("shadows in the shipped scenes agree with the reference", "[long]") {
  check_shipped({"room", "bars", "closed_box", "penumbra"});
}

TEST_CASE("no diode is wrong in some random scenes", "[smoke]") { check_random_shadows(300, 305); }

TEST_CASE("no diode is wrong in random scenes", "[long]") { check_random_shadows(300, 500); }

namespace {

void check_any_lens(std::uint32_t first, std::uint32_t last) {
  fmt::print("{}", comparison_heading());
  for (std::uint32_t seed = first; seed < last; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const Sensor sensor = random_sensor(random, seed);
    const Scene scene = random_triangles(random, 60, sensor.world_from_camera);
    const Illuminator light = random_illuminator(random, 3 + 9 * (seed % 5), sensor.world_from_camera);
    const Backscatter backscatter = random.flip() ? Backscatter::lambert : Backscatter::constant;
    const auto expected = reference::simulate(scene, sensor, {light}, backscatter, reference_options);
    Simulator simulator = make_simulator(random_options(random));
    simulator.prepare(scene, sensor, {light}, backscatter, Shadows::automatic);
    const Measurement measured = simulator.measure();
    const ReachedComparison reached = compare_reached(measured, expected, scene, sensor, {light});
    const Comparison comparison =
        compare(measured, expected, scene, sensor,
                not_comparable(reached, pixels_in_grazing_light(expected, scene, sensor, light)));
    fmt::print("{}", comparison_row(fmt::format("{}: S = {}, reached {:.1f} %", seed, sensor.samples,
                                                100.0 * static_cast<double>(reached.reached) /
                                                    static_cast<double>(reached.pairs)),
                                    comparison));
    CHECK(reached.clear_of_all == 0);
    CHECK(reached.lit_error <= 1e-6);
    CHECK(reached.reached < reached.pairs);
    CHECK(comparison.pixels >= sensor.pixel_count() / 10);
    CHECK(comparison.distance_max_m <= 2e-6);
    CHECK(comparison.amplitude_max_relative <= 1e-5);
    CHECK(comparison.disagreements == 0);
  }
}

} // namespace

TEST_CASE("shadows behind some lenses, of some signals, agree with the reference") {
  check_any_lens(900, 903);
}

TEST_CASE("shadows behind any lens, of any signal, agree with the reference", "[long]") {
  check_any_lens(900, 912);
}

TEST_CASE("shadows all around a fisheye agree with the reference", "[long]") {
  Random random(930);
  Sensor sensor;
  sensor.resolution = {160, 120};
  sensor.pixel_pitch_m = glm::dvec2(1e-4);
  sensor.focal_length_m = 4.5e-3; // 255 degrees along the diagonal
  sensor.distortion = Fisheye{};
  sensor.samples = 2;
  sensor.world_from_camera = random.pose(10.0);
  SceneBuilder builder(sensor.world_from_camera);
  for (int i = 0; i < 600; ++i) {
    const double range_m = random.uniform(0.6, 3.0), size_m = random.uniform(0.02, 0.4);
    const glm::dvec3 centre_m = range_m * random.unit_vector();
    std::array<glm::dvec3, 3> corners_m;
    for (glm::dvec3 &corner_m : corners_m)
      corner_m = centre_m + size_m * random.unit_vector();
    builder.add_triangle(corners_m[0], corners_m[1], corners_m[2], {0.5, random.flip()});
  }
  const Illuminator light = random_illuminator(random, 60, sensor.world_from_camera);
  const auto expected =
      reference::simulate(builder.scene(), sensor, {light}, Backscatter::lambert, reference_options);
  fmt::print("{}", reached_heading());
  for (const Variant &variant : variants) {
    INFO(variant.name);
    Simulator simulator = make_simulator(options_of(variant));
    simulator.prepare(builder.scene(), sensor, {light}, Backscatter::lambert, Shadows::automatic);
    const ReachedComparison reached =
        compare_reached(simulator.measure(), expected, builder.scene(), sensor, {light});
    fmt::print("{}", reached_row("a fisheye of 255 degrees" + variant.name, reached));
    CHECK(reached.samples > 20'000);
    CHECK(reached.differing_fraction() <= 1e-4);
    CHECK(reached.clear_of_all == 0);
    CHECK(reached.lit_error <= 1e-6);
  }
}

TEST_CASE("where nothing can block, shadows change no bit") {
  const Setup setup = shipped("paper_ring");
  const auto &[scene, sensors, illuminators, others] = setup.start;
  Simulator simulator = make_simulator(options_of(variants[0]));
  simulator.prepare(scene, sensors[0], illuminators, setup.backscatter, Shadows::off);
  const Measurement off = simulator.measure();
  CHECK(off.lit.empty());
  CHECK(off.sample_visibility.empty());
  simulator.prepare(scene, sensors[0], illuminators, setup.backscatter, Shadows::automatic);
  const Measurement automatic = simulator.measure();
  check_same_light(automatic, off);
  CHECK(all_one(automatic.lit));
}

TEST_CASE("nothing in a closed box shades it") {
  const Setup setup = shipped("closed_box");
  const auto &[scene, sensors, illuminators, others] = setup.start;
  Simulator simulator = make_simulator(options_of(variants[0]));
  simulator.prepare(scene, sensors[0], illuminators, setup.backscatter, Shadows::automatic);
  const Measurement measured = simulator.measure();
  CHECK(all_one(measured.lit));
  CHECK(all_one(measured.coverage));
}
