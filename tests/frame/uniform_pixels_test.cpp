// Frames of mode auto against those of mode exact: pixels that few diodes or one place stand in for, and
// their neighbours that need all.

#include "host/input/setup/setup.h"
#include "tests/comparison/frame_difference.h"
#include "tests/comparison/light_formula.h"
#include "tests/comparison/variants.h"
#include "tests/support/painted_scenes.h"
#include "tests/support/random_scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <optional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Case {
  std::string name;
  Scene scene{};
  Sensor sensor{};
  std::vector<Illuminator> lights{};
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::off;
  double max_error_m = 10e-6, max_amplitude_error = 1e-3;
  std::uint32_t fewer_than = 0; // diodes; 0: as many as there are
  std::optional<Precision> precision{};
  bool empty_pixels = false;
};

Measurement measure(const Case &of, const SimulatorOptions &options, const Accuracy &accuracy) {
  Simulator simulator = make_simulator(options);
  simulator.prepare(of.scene, of.sensor, of.lights, of.backscatter, of.shadows, accuracy);
  return simulator.measure();
}

Accuracy within(const Case &of) {
  return {.mode = Mode::automatic,
          .precision = of.precision,
          .max_error_m = of.max_error_m,
          .max_amplitude_error = of.max_amplitude_error};
}

void check_report(const Case &of, const AccuracyReport &report) {
  const std::size_t pixels = of.sensor.pixel_count();
  CHECK(report.checked_pixels == std::min<std::size_t>(1024, pixels));
  CHECK(report.check_ms > 0.0);
  const double rounding_m = 0x1p-24 * of.sensor.ambiguity_m();
  REQUIRE(report.claimed_m);
  REQUIRE(report.found_m);
  CHECK(*report.claimed_m <= of.max_error_m);
  CHECK(*report.found_m <= *report.claimed_m + rounding_m);
  REQUIRE(report.claimed_amplitude);
  REQUIRE(report.found_amplitude);
  CHECK(*report.claimed_amplitude <= of.max_amplitude_error);
  CHECK(*report.found_amplitude <= *report.claimed_amplitude + 0x1p-23);
  const std::size_t all = diode_count(of.lights);
  CHECK(report.diodes > 0);
  CHECK(report.diodes <= all);
  if (of.fewer_than > 0)
    CHECK(report.diodes < of.fewer_than);
}

void check(const Case &of) {
  const Measurement exact = measure(of, {.device = {}, .keep_taps = true}, {.precision = Precision::fp64});
  for (const Variant &variant : variants) {
    INFO(of.name << variant.name);
    const SimulatorOptions options{.device = {},
                                   .keep_taps = true,
                                   .precision = variant.precision,
                                   .loop = variant.loop,
                                   .allowed = {.unsorted = false}}; // which has no such pixels
    const Measurement automatic = measure(of, options, within(of));
    const FrameDifference apart = difference(automatic, exact, of.sensor);
    const AccuracyReport &report = automatic.accuracy;
    fmt::print("{:<46}{:>8}{:>9.4f} um{:>9.4f} um{:>11.2e}{:>7}\n", of.name + variant.name, apart.lit,
               1e6 * apart.distance_m, 1e6 * report.claimed_m.value_or(0.0), apart.amplitude, report.diodes);
    const double rounding_m = 0x1p-23 * of.sensor.ambiguity_m();
    CHECK(apart.lit > of.sensor.pixel_count() / 10);
    CHECK(apart.distance_m <= of.max_error_m + rounding_m);
    CHECK(apart.amplitude <= of.max_amplitude_error);
    CHECK(apart.taps <= of.max_amplitude_error + full_turn_rad * of.max_error_m / of.sensor.ambiguity_m());
    CHECK(apart.truth_m <= of.max_error_m + 0x1p-22 * 10.0);
    CHECK(apart.disagreements == 0);
    CHECK((apart.empty > 0) == of.empty_pixels);
    CHECK(apart.badly_empty == 0);
    check_report(of, report);
  }
}

Case shipped_ring(std::uint32_t samples) {
  const Setup setup = load_setup(PMDSIM_SCENES "/paper_ring.json");
  Case result{.name = fmt::format("paper_ring, S = {}", samples),
              .scene = setup.start.scene,
              .sensor = setup.start.sensors[0],
              .lights = {setup.start.illuminators[0]},
              .backscatter = setup.backscatter,
              .max_error_m = 1e-6,
              .fewer_than = 40};
  result.sensor.resolution /= 8u;
  result.sensor.pixel_pitch_m *= 8.0;
  result.sensor.samples = samples;
  return result;
}

// A wall across the view's left half, in front of one that falls away to the right, and a floor at the height
// of a diode's middle, which some diodes are above and some below. Above all this nothing.
Scene corner() {
  SceneBuilder builder;
  builder.add_wall({2.0, {0.7}, {-3.0, -0.4}, {0.0, 3.0}});
  builder.add_mesh({{0.0, -0.4, 2.5}, {0.0, 3.0, 2.5}, {3.0, 3.0, 4.0}, {3.0, -0.4, 4.0}},
                   {{0, 1, 2}, {0, 2, 3}}, {0.4, true});
  builder.add_mesh({{-3.0, 0.1, 1.5}, {-3.0, 0.1, 4.0}, {3.0, 0.1, 4.0}, {3.0, 0.1, 1.5}},
                   {{0, 1, 2}, {0, 2, 3}}, {0.9, true});
  return builder.scene();
}

Case in_corner(const std::string &name, std::uint32_t samples) {
  Case result{.name = fmt::format("{}, S = {}", name, samples),
              .scene = corner(),
              .sensor = wide_sensor(),
              .lights = {light_at(ring(90, 0.15), 0.0, {Pattern::Kind::cosine, 1.0})},
              .fewer_than = 90,
              .empty_pixels = true};
  result.sensor.samples = samples;
  return result;
}

// The same corner, partly in the shadow of a post.
Case behind_a_post(const std::string &name, std::uint32_t samples) {
  Case of = in_corner(name, samples);
  SceneBuilder post;
  const auto first = static_cast<std::uint32_t>(of.scene.positions_m.size());
  post.add_wall({1.0, {0.5, true}, {-0.3, -0.5}, {-0.2, 0.05}});
  for (const glm::dvec3 &corner_m : post.scene().positions_m)
    of.scene.positions_m.push_back(corner_m);
  for (Triangle triangle : post.scene().triangles) {
    for (std::uint32_t &vertex : triangle.vertices)
      vertex += first;
    of.scene.triangles.push_back(triangle);
  }
  of.shadows = Shadows::automatic;
  return of;
}

// A wall that falls away at 60 degrees, 2 to 5 m off, in pixels of 9 mrad.
Case on_steep_wall(std::uint32_t samples) {
  SceneBuilder builder;
  builder.add_mesh({{-1.5, -2.0, 0.4}, {-1.5, 2.0, 0.4}, {1.5, 2.0, 5.6}, {1.5, -2.0, 5.6}},
                   {{0, 1, 2}, {0, 2, 3}}, {0.6, true});
  Case result{.name = fmt::format("steep wall, S = {}", samples),
              .scene = builder.scene(),
              .sensor = wide_sensor(),
              .lights = {light_at({{0.1, 0.02, -0.05}}, 0.0, {Pattern::Kind::cosine, 1.0})},
              .precision = Precision::fp32,
              .empty_pixels = true};
  result.sensor.pixel_pitch_m /= 2.0;
  result.sensor.samples = samples;
  return result;
}

// Two lights along the plane that ends both their beams, which crosses a wall at 4 m aslant: near it a
// cosine's rounding is much of each light, of one not as of the other.
Case at_rims_of_beams() {
  SceneBuilder builder;
  builder.add_wall({4.0, {0.5}, {-4.0, -4.0}, {4.0, 4.0}});
  Case result{.name = "rims of beams",
              .scene = builder.scene(),
              .sensor = wide_sensor(),
              .backscatter = Backscatter::constant,
              .max_error_m = 100e-6,
              .max_amplitude_error = 3e-4};
  result.sensor.resolution *= 8u;
  result.sensor.pixel_pitch_m /= 8.0;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.35, 0.9, 0.05));
  const glm::dvec3 along = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
  for (const double place_m : {-0.75, 0.75}) {
    result.lights.push_back(light_at({place_m * along}, 0.0, {Pattern::Kind::cosine, 3.0}));
    result.lights.back().diodes[0].axis = axis;
  }
  return result;
}

std::size_t other_amplitudes(const Measurement &a, const Measurement &b) {
  std::size_t other = 0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i)
    other += a.returns[0].amplitude[i] != b.returns[0].amplitude[i];
  return other;
}

void check_on_steep_wall(std::uint32_t samples) {
  const Case of = on_steep_wall(samples);
  check(of);
  const Measurement one_point = measure(on_steep_wall(1), {}, {}), all = measure(of, {}, {});
  const Measurement automatic = measure(of, {}, within(of));
  // It is not off by so much, and yet many pixels are not summed sample by sample, which has the same bits.
  CHECK(difference(one_point, all, of.sensor).distance_m > 2.0 * of.max_error_m);
  if (samples > 2)
    CHECK(other_amplitudes(automatic, all) > of.sensor.pixel_count() / 4);
  CHECK(difference(automatic, all, of.sensor).distance_m < 0.2 * of.max_error_m);
}

} // namespace

TEST_CASE("four points stand in for samples that one point is too far from") { check_on_steep_wall(4); }

TEST_CASE("four points stand in for samples that one point is too far from, other samples", "[long]") {
  for (const std::uint32_t samples : {2u, 3u, 8u})
    check_on_steep_wall(samples);
}

TEST_CASE("few diodes stand in for the paper's ring", "[long]") {
  for (const std::uint32_t samples : {1u, 2u, 4u})
    check(shipped_ring(samples));
}

TEST_CASE("surfaces that part of the light is behind", "[long]") {
  for (const std::uint32_t samples : {1u, 2u, 4u})
    check(in_corner("corner", samples));
}

TEST_CASE("frequencies from one sum", "[long]") {
  for (const std::uint32_t samples : {1u, 2u}) {
    Case of = in_corner("20 and 60 MHz", samples);
    of.sensor.modulation_hz = {20e6, 60e6};
    check(of);
  }
}

TEST_CASE("more frequencies than the uniform-pixel pass has room for", "[long]") {
  Case of = in_corner("10 to 50 MHz", 1);
  of.sensor.modulation_hz = {10e6, 20e6, 30e6, 40e6, 50e6};
  check(of);
}

TEST_CASE("chips that stand askew, pixels that are filled in part, cos^4", "[long]") {
  for (const std::uint32_t samples : {1u, 2u}) {
    Case tilted = in_corner("tilted chip", samples);
    tilted.sensor.chip = {{0.1, -0.05, 0.2}, {0.02, -0.01, 0.03}};
    check(tilted);
    Case filled = in_corner("fill factor 0.5", samples);
    filled.sensor.fill_factor = {0.5, 0.5};
    check(filled);
    Case dim = in_corner("vignetting", samples);
    dim.sensor.vignetting = Vignetting::cos4;
    check(dim);
  }
}

namespace {

Case painted_shapes(std::uint32_t samples) {
  Random random(31);
  Case of{.name = fmt::format("paint, S = {}", samples),
          .sensor = wide_sensor(),
          .lights = {light_at(ring(60, 0.1), 0.0)},
          .fewer_than = 60,
          .empty_pixels = true};
  of.scene = random_triangles(random, 60, of.sensor.world_from_camera);
  paint(random, of.scene);
  scatter_discs(random, 40, of.sensor.world_from_camera, of.scene);
  of.sensor.samples = samples;
  return of;
}

} // namespace

TEST_CASE("painted surfaces and points", "[long]") { check(painted_shapes(2)); }

TEST_CASE("painted surfaces and points, one sample a pixel", "[long]") { check(painted_shapes(1)); }

TEST_CASE("a single diode, and diodes that are turned from what is seen", "[long]") {
  for (const std::uint32_t samples : {1u, 4u}) {
    Case single = in_corner("single diode", samples);
    single.lights = {light_at({{0.1, 0.02, -0.05}}, 0.0, {Pattern::Kind::cosine, 4.0})};
    single.fewer_than = 2;
    check(single);
    Case half_spaces = in_corner("half-spaces that end in view", samples);
    half_spaces.lights = {light_at(ring(30, 0.05), 0.0, {Pattern::Kind::cosine, 0.0})};
    for (Diode &diode : half_spaces.lights[0].diodes)
      diode.axis = glm::normalize(glm::dvec3(1.0, 0.0, 0.05));
    half_spaces.fewer_than = 0;
    check(half_spaces);
  }
}

TEST_CASE("beams end in view", "[long]") {
  const Case of = at_rims_of_beams();
  check(of);
  // In float alone it could not be promised.
  const Measurement in_float = measure(of, {}, {}), exact = measure(of, {}, {.precision = Precision::fp64});
  CHECK(difference(in_float, exact, of.sensor).amplitude > of.max_amplitude_error);
  // So the pixels at the rims are summed in double, and no others.
  const Measurement in_part = measure(of, {}, within(of));
  CHECK(in_part.accuracy.precision == Precision::fp32);
  CHECK(in_part.accuracy.unpromised == 0);
  CHECK(difference(in_part, exact, of.sensor).amplitude <= of.max_amplitude_error);
}

TEST_CASE("few diodes in the precision that was asked for", "[long]") {
  for (const Precision precision : {Precision::fp32, Precision::fp64}) {
    Case of = in_corner(precision == Precision::fp64 ? "fp64" : "fp32", 1);
    of.precision = precision;
    check(of);
    CHECK(measure(of, {}, within(of)).accuracy.precision == precision);
  }
}

TEST_CASE("lights half a radian apart", "[long]") {
  Case of = in_corner("phased", 2);
  of.lights.push_back(light_at(ring(40, 0.08), 0.5));
  of.fewer_than = 130;
  check(of);
}

TEST_CASE("shadows that leave part of the light") { check(behind_a_post("shadows", 1)); }

TEST_CASE("shadows that leave part of the light, more samples a pixel and both precisions", "[long]") {
  Case several = behind_a_post("shadows", 2);
  several.fewer_than = 0; // the host's sum over all of them is shorter than sorting the pixels
  check(several);
  for (const std::uint32_t samples : {1u, 2u}) {
    // Few diodes, but none in the uniform-pixel pass, which is in float.
    Case precise = behind_a_post("shadows, fp64", samples);
    precise.precision = Precision::fp64;
    check(precise);
  }
}

TEST_CASE("samples that adapt cost no more than was promised, whatever the mode") {
  Case of = in_corner("adaptive samples", 4);
  of.sensor.adaptive_samples = true;
  Accuracy accuracy;
  accuracy.max_error_m = of.max_error_m;
  const Measurement adaptive = measure(of, {}, accuracy);
  of.sensor.adaptive_samples = false;
  const FrameDifference apart = difference(adaptive, measure(of, {}, {}), of.sensor);
  CHECK(apart.distance_m <= of.max_error_m + 0x1p-23 * of.sensor.ambiguity_m());
  CHECK(apart.disagreements == 0);
  CHECK(adaptive.accuracy.diodes == 90);
  CHECK_FALSE(adaptive.accuracy.found_m);
  CHECK(adaptive.accuracy.checked_pixels == 0);
}
