// A deformation that is little more than a float's step at that distance: what light beside the lens adds to
// the distance that light in the lens gives.

#include "engine/reference/reference.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double ring_radius_m = 0.010, ring_wall_m = 2.0;

struct DeformationCase {
  std::string name;
  SimulatorOptions options{};
  Accuracy accuracy{};
  std::uint32_t samples = 1;
  Waveform waveform{};
  Shadows shadows = Shadows::off;
  double within = 1e-7; // the error over the deformation
};

SimulatorOptions without_host() {
  SimulatorOptions options;
  options.allowed.host_pixels = options.allowed.host_sum = options.allowed.point_polynomials = false;
  return options;
}

SimulatorOptions pairs_of_floats() {
  SimulatorOptions options;
  options.precision = SamplePrecision::double_float;
  return options;
}

SimulatorOptions from_points() {
  SimulatorOptions options;
  options.allowed.depth_records = false;
  return options;
}

Accuracy with(Precision precision) {
  Accuracy accuracy;
  accuracy.precision = precision;
  return accuracy;
}

Accuracy within_a_millimetre() {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = 1e-3;
  return accuracy;
}

std::vector<DeformationCase> deformation_cases() {
  // The sum's own: of a float's rounding; of phases of several samples, each some millimetres beside the
  // first; and of few diodes in place of all.
  constexpr double of_float = 1e-4, of_samples = 1e-3, of_few_diodes = 1e-2;
  const Waveform square{Waveform::Kind::square, {}};
  return {{"fp64", {}, with(Precision::fp64)},
          {"fp64, pairs of floats", pairs_of_floats(), with(Precision::fp64)},
          {"fp32", {}, with(Precision::fp32), 1, {}, Shadows::off, of_float},
          {"fp32, on the device", without_host(), with(Precision::fp32), 1, {}, Shadows::off, of_float},
          {"fp32, from points", from_points(), with(Precision::fp32), 1, {}, Shadows::off, of_float},
          {"fp32, pairs of floats", pairs_of_floats(), with(Precision::fp32), 1, {}, Shadows::off, of_float},
          {"fp64, shadows, 2 x 2", {}, with(Precision::fp64), 2, {}, Shadows::automatic},
          {"fp32, shadows, 2 x 2", {}, with(Precision::fp32), 2, {}, Shadows::automatic, of_samples},
          {"fp64, square", {}, with(Precision::fp64), 1, square},
          {"within 1 mm", {}, within_a_millimetre(), 2, {}, Shadows::off, of_few_diodes}};
}

Sensor deforming_sensor(const DeformationCase &of) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {40, 30};
  sensor.samples = of.samples;
  sensor.waveform = of.waveform;
  return sensor;
}

std::vector<Illuminator> small_ring() { return {light_at(ring(240, ring_radius_m), 0.0)}; }

Measurement measured_in_double(const DeformationCase &of, const Sensor &sensor,
                               const std::vector<Illuminator> &light) {
  SimulatorOptions options = of.options;
  options.keep_unrounded = true;
  Simulator simulator = make_simulator(options);
  const Scene scene = wall_at(ring_wall_m);
  simulator.prepare(scene, sensor, light, Backscatter::lambert, of.shadows, of.accuracy);
  return simulator.measure();
}

struct DeformationErrors {
  double unrounded = 0.0, rounded = 0.0; // the largest over the deformation
};

DeformationErrors deformation_errors(const DeformationCase &of) {
  const Sensor sensor = deforming_sensor(of);
  const std::vector<Illuminator> in_lens{monostatic_illuminator(sensor.world_from_camera)};
  const auto exact = [&](const std::vector<Illuminator> &light) {
    return reference::simulate(wall_at(ring_wall_m), sensor, light, Backscatter::lambert)
        .returns[0]
        .distance_m;
  };
  const std::vector<double> beside_m = exact(small_ring()), in_lens_m = exact(in_lens);
  const Return found = measured_in_double(of, sensor, small_ring()).returns[0],
               monostatic = measured_in_double(of, sensor, in_lens).returns[0];
  DeformationErrors errors;
  for (std::size_t i = 0; i < beside_m.size(); ++i) {
    const double expected_m = beside_m[i] - in_lens_m[i];
    const double unrounded_m = found.unrounded_distance_m[i] - monostatic.unrounded_distance_m[i];
    const double rounded_m =
        static_cast<double>(found.distance_m[i]) - static_cast<double>(monostatic.distance_m[i]);
    errors.unrounded = std::max(errors.unrounded, std::abs(unrounded_m - expected_m) / std::abs(expected_m));
    errors.rounded = std::max(errors.rounded, std::abs(rounded_m - expected_m) / std::abs(expected_m));
  }
  return errors;
}

void check_digits(const std::vector<DeformationCase> &cases) {
  fmt::print("{:<24}{:>24}{:>24}\n", "error over deformation", "distances in double", "rounded to float");
  for (const DeformationCase &of : cases) {
    INFO(of.name);
    const DeformationErrors errors = deformation_errors(of);
    fmt::print("{:<24}{:>24.2e}{:>24.2e}\n", of.name, errors.unrounded, errors.rounded);
    CHECK(errors.unrounded <= of.within);
    CHECK(errors.rounded > 1e-3); // else it would need no double
  }
}

} // namespace

TEST_CASE("the deformation of a ring of 10 mm before a wall at 2 m keeps its digits") {
  check_digits(every_third(deformation_cases()));
}

TEST_CASE("the deformation of a ring of 10 mm before a wall at 2 m keeps its digits in every way", "[long]") {
  check_digits(deformation_cases());
}

TEST_CASE("on the axis it is that of one way to the ring and back") {
  Sensor sensor = axial_sensor();
  const double expected_m = 0.5 * (std::hypot(ring_wall_m, ring_radius_m) - ring_wall_m);
  for (const Precision precision : {Precision::fp64, Precision::fp32}) {
    const DeformationCase of{"axis", {}, with(precision)};
    const auto distance_m = [&](const std::vector<Illuminator> &light) {
      return measured_in_double(of, sensor, light).returns[0].unrounded_distance_m[0];
    };
    const double found_m =
        distance_m(small_ring()) - distance_m({monostatic_illuminator(sensor.world_from_camera)});
    INFO("off by " << (found_m - expected_m) / expected_m);
    CHECK(std::abs(found_m - expected_m) <= 1e-5 * expected_m);
  }
}
