// The sum in float and in double against the reference, beside what theory says that rounding may do.

#include "engine/error_budget/rounding_bound.h"
#include "engine/light/source_groups.h"
#include "engine/view/projection.h"
#include "host/input/setup/setup.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/grazing_light.h"
#include "tests/comparison/light_formula.h"
#include "tests/comparison/variants.h"
#include "tests/error_budget/least_incidence.h"
#include "tests/support/random_diagrams.h"
#include "tests/support/random_scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Case {
  std::string name;
  Scene scene;
  Sensor sensor; // without distortion
  std::vector<Illuminator> lights;
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::off;
  std::vector<bool> left_out{};
};

// Where all phases agree within a quarter of a radian.
constexpr double condition_of_one_light = 1.02;

RoundingBound bound_of(const Case &of, Precision precision) {
  constexpr std::uint32_t one_block = 8192;
  const CameraScene camera = to_camera(of.scene, of.sensor);
  const std::vector<CameraIlluminator> lights = to_camera(of.lights, of.sensor);
  const Projection projection = project(camera, chip_blocks(of.sensor, one_block));
  const Modulation signal = modulation_of(of.sensor, {});
  const SourceGroups groups =
      group_diodes(lights, projection.visible, signal.largest_wavenumber_rad_m(), precision);
  const SumModel model = sum_model(lights, of.backscatter, all_face_the_light(camera, lights));
  return rounding_bound(groups, projection.visible, model, signal,
                        {.precision = precision,
                         .samples = of.sensor.samples,
                         .incidence_cosine = least_incidence_cosine(camera, groups, projection.visible),
                         .emission_cosine = least_emission_cosine(groups, projection.visible)})
      .value();
}

reference::Frame reference_of(const Case &of, const std::vector<Illuminator> &lights) {
  return reference::simulate(of.scene, of.sensor, lights, of.backscatter, {.shadows = of.shadows});
}

Comparison measure(const Case &of, const reference::Frame &expected, Precision precision,
                   const Variant &variant) {
  Simulator simulator = make_simulator(
      {.device = {}, .keep_sample_ids = true, .precision = variant.precision, .loop = variant.loop});
  simulator.prepare(of.scene, of.sensor, of.lights, of.backscatter, of.shadows, {.precision = precision});
  return compare(simulator.measure(), expected, of.scene, of.sensor, of.left_out);
}

void print_heading() {
  fmt::print("{:<44}{:>8}{:>14}{:>12}{:>14}{:>12}\n", "", "pixels", "distance", "bound", "amplitude",
             "bound");
}

// Both precisions of a case; the errors of double are left.
Comparison check_precisions(const Case &of, const Variant &variant, double condition) {
  const reference::Frame expected = reference_of(of, of.lights);
  Comparison comparison;
  for (const Precision precision : {Precision::fp32, Precision::fp64}) {
    const RoundingBound bound = bound_of(of, precision);
    comparison = measure(of, expected, precision, variant);
    const std::string name =
        fmt::format("{}, {}{}", of.name, precision == Precision::fp64 ? "fp64" : "fp32", variant.name);
    fmt::print("{:<44}{:>8}{:>11.4f} um{:>9.4f} um{:>14.2e}{:>12.2e}\n", name, comparison.pixels,
               1e6 * comparison.distance_max_m, 1e6 * bound.distance_m(condition),
               comparison.amplitude_max_relative, bound.amplitude(condition));
    INFO(name);
    CHECK(comparison.pixels >= of.sensor.pixel_count() / 20);
    CHECK(comparison.distance_max_m <= bound.distance_m(condition));
    CHECK(comparison.amplitude_max_relative <= bound.amplitude(condition));
  }
  return comparison;
}

Case shipped(const std::string &scene, std::uint32_t samples) {
  const Setup setup = load_setup(std::string(PMDSIM_SCENES "/") + scene + ".json");
  Case result{fmt::format("{}, S = {}", scene, samples),
              setup.start.scene,
              setup.start.sensors[0],
              {setup.start.illuminators[0]},
              setup.backscatter,
              setup.shadows};
  result.sensor.samples = samples;
  result.sensor.resolution /= 4u;
  result.sensor.pixel_pitch_m *= 4.0;
  return result;
}

Case random_case(std::uint32_t seed) {
  Random random(seed);
  Case result{.name = fmt::format("seed {}", seed), .scene = {}, .sensor = {}, .lights = {}};
  result.sensor.resolution = {72, 48};
  result.sensor.pixel_pitch_m = {1e-3, 1.2e-3};
  result.sensor.focal_length_m = 0.1;
  result.sensor.world_from_camera = random.pose(30.0);
  if (seed % 3 == 0)
    result.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, -0.1}};
  result.scene = random_triangles(random, 60, result.sensor.world_from_camera);
  result.lights = {random_illuminator(random, 1 + 20 * (seed % 4), result.sensor.world_from_camera)};
  result.backscatter = seed % 2 == 0 ? Backscatter::lambert : Backscatter::constant;
  result.left_out = pixels_in_grazing_light(reference_of(result, result.lights), result.scene, result.sensor,
                                            result.lights[0]);
  return result;
}

// Every third diode of a ring a third of a turn behind the one before, and one in three a hair stronger: all
// over the image little more than that hair is left.
Case cancelling(double stronger, const Pattern &pattern) {
  Case result{.name = fmt::format("1 against {}, order {}", stronger, pattern.order),
              .scene = wall_at(2.0, {0.7}),
              .sensor = wide_sensor(),
              .lights = {}};
  const std::vector<glm::dvec3> places_m = ring(33, 0.1);
  for (std::size_t third = 0; third < 3; ++third) {
    std::vector<glm::dvec3> of_light_m;
    for (std::size_t i = third; i < places_m.size(); i += 3)
      of_light_m.push_back(places_m[i]);
    result.lights.push_back(light_at(of_light_m, static_cast<double>(third) * 120 * degree, pattern));
  }
  for (Diode &diode : result.lights[1].diodes)
    diode.intensity_w_sr = stronger;
  return result;
}

// The condition of the pixel that cancels most, from the returns of each light alone.
double largest_condition(const Case &of) {
  const reference::Frame together = reference_of(of, of.lights);
  std::vector<double> terms(of.sensor.pixel_count(), 0.0);
  for (const Illuminator &light : of.lights) {
    const reference::Frame alone = reference_of(of, {light});
    for (std::size_t i = 0; i < terms.size(); ++i)
      terms[i] += condition_of_one_light * alone.returns[0].amplitude[i];
  }
  double largest = 1.0;
  for (std::size_t i = 0; i < terms.size(); ++i)
    largest = std::max(largest, terms[i] / together.returns[0].amplitude[i]);
  return largest;
}

void check_shipped(const std::vector<std::string> &scenes, std::uint32_t most_samples) {
  print_heading();
  for (const std::string &scene : scenes)
    for (std::uint32_t samples = 1; samples <= most_samples; ++samples)
      for (const Variant &variant : variants) {
        const Case of = shipped(scene, samples);
        const Comparison comparison = check_precisions(of, variant, condition_of_one_light);
        const double farthest_m = 4.05;
        CHECK(comparison.distance_max_m <= 0x1p-24 * farthest_m + 5e-9);
      }
}

void check_random_cases(std::uint32_t first, std::uint32_t last) {
  print_heading();
  for (std::uint32_t seed = first; seed < last; ++seed)
    check_precisions(random_case(seed), variants[seed % 2], condition_of_one_light);
}

struct DoubleCase {
  Case of;
  double farthest_m = 0.0;
};

// Of any waveform, phase and diagram.
std::vector<DoubleCase> double_cases() {
  Case plain = shipped("paper_ring", 2);
  plain.sensor.resolution = {16, 16};
  plain.sensor.pixel_pitch_m *= 10.0;
  Random random(5);
  const auto of_diagram = [&](bool axial) {
    const Pattern measured{Pattern::Kind::diagram, 0.0, random_diagram(random, axial)};
    Case of = plain;
    for (Diode &diode : of.lights[0].diodes)
      diode.pattern = measured;
    return of;
  };
  Case square = plain, harmonics = plain, far = plain;
  square.sensor.waveform = {Waveform::Kind::square, {}};
  harmonics.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, -0.1}};
  far.sensor.modulation_hz = {1e6};
  far.lights[0].modulation_phase_rad = -0.9;
  return {
      {square, 4.05}, {harmonics, 4.05}, {far, 128.0}, {of_diagram(true), 4.05}, {of_diagram(false), 4.05}};
}

void check_double(const std::vector<DoubleCase> &cases) {
  for (const auto &[of, farthest_m] : cases) {
    const reference::Frame expected = reference_of(of, of.lights);
    for (const Variant &variant : variants) {
      const Comparison in_double = measure(of, expected, Precision::fp64, variant);
      CHECK(in_double.pixels >= of.sensor.pixel_count() / 20);
      CHECK(in_double.distance_max_m <= 0x1p-24 * farthest_m + 5e-9);
    }
  }
}

void check_cancelling(const std::vector<std::pair<double, Pattern>> &cases) {
  print_heading();
  for (const auto &[stronger, pattern] : cases) {
    const Case of = cancelling(stronger, pattern);
    const double condition = largest_condition(of);
    const reference::Frame expected = reference_of(of, of.lights);
    const Comparison in_float = measure(of, expected, Precision::fp32, variants[0]);
    for (const Variant &variant : variants) {
      const Comparison in_double = check_precisions(of, variant, condition);
      CHECK(in_float.distance_max_m > 10.0 * in_double.distance_max_m);
    }
  }
}

} // namespace

TEST_CASE("a shipped scene stays within the bounds of rounding, in double within the output's") {
  check_shipped({"paper_half_ring"}, 1);
}

TEST_CASE("shipped scenes stay within the bounds of rounding, in double within the output's", "[long]") {
  check_shipped({"paper_ring", "paper_half_ring", "room"}, 2);
}

TEST_CASE("some random lights stay within the bounds of rounding", "[smoke]") {
  check_random_cases(700, 703);
}

TEST_CASE("random lights stay within the bounds of rounding", "[long]") { check_random_cases(700, 712); }

TEST_CASE("double leaves nothing but the output's rounding, in some cases") {
  check_double(every_third(double_cases()));
}

TEST_CASE("double leaves nothing but the output's rounding, of any waveform, phase and diagram", "[long]") {
  check_double(double_cases());
}

TEST_CASE("where returns cancel, double keeps what float loses") { check_cancelling({{1.00001, {}}}); }

TEST_CASE("where returns cancel, double keeps what float loses, of any beam", "[long]") {
  using Kind = Pattern::Kind;
  check_cancelling({{1.01, {}}, {1.00001, {Kind::cosine, 3.0}}, {1.00001, {Kind::cosine, 12.5}}});
}
