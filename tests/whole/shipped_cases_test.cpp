// The cases of scenes/analytic: each setup says which physics it shows and what its pixels read.

#include "host/input/setup/setup.h"
#include "tests/comparison/engines.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Setup analytic_setup(const std::string &name) {
  return load_setup(PMDSIM_SCENES "/analytic/" + name + ".json");
}

Measurement measure(Engine engine, const Setup &setup) {
  return measure(engine, setup.start.scene, setup.start.sensors[0], setup.start.illuminators[0],
                 setup.backscatter);
}

// The phasor of a return of the given strength from the given distance under monostatic light.
std::complex<double> monostatic_return(double strength, double distance_m, const Sensor &sensor) {
  return std::polar(strength, 2 * std::numbers::pi * distance_m / sensor.ambiguity_m());
}

} // namespace

TEST_CASE("distances wrap at 10 MHz") {
  const Engine engine = both_engines();
  const Setup setup = analytic_setup("wrap_10mhz");
  const Measurement frame = measure(engine, setup);
  const std::vector<double> true_m{15, 20, 49}, stated_m{0.010377, 5.010377, 4.031131};
  REQUIRE(frame.returns[0].distance_m.size() == true_m.size());
  for (std::size_t pixel = 0; pixel < true_m.size(); ++pixel) {
    check_distance(engine, fmt::format("wrap at 10 MHz, {} m", true_m[pixel]), true_m[pixel],
                   setup.start.sensors[0], frame.returns[0].distance_m[pixel]);
    CHECK(frame.returns[0].distance_m[pixel] ==
          Approx(stated_m[pixel]).epsilon(0).margin(0.5e-6 + 1e-7 * true_m[pixel]));
  }
}

TEST_CASE("a baseline of 5 cm lengthens the path") {
  const Engine engine = both_engines();
  const Setup setup = analytic_setup("on_axis_baseline");
  const Measurement frame = measure(engine, setup);
  const std::vector<double> depths_m{0.5, 1, 2, 5}, stated_excess_mm{1.246891, 0.624610, 0.312451, 0.124997};
  REQUIRE(frame.returns[0].distance_m.size() == depths_m.size());
  for (std::size_t pixel = 0; pixel < depths_m.size(); ++pixel) {
    const double z_m = depths_m[pixel];
    check_distance(engine, fmt::format("5 cm baseline, {} m", z_m), (z_m + std::hypot(z_m, 0.05)) / 2,
                   setup.start.sensors[0], frame.returns[0].distance_m[pixel]);
    CHECK(1e3 * (frame.returns[0].distance_m[pixel] - z_m) ==
          Approx(stated_excess_mm[pixel]).epsilon(0).margin(2e-3));
  }
}

TEST_CASE("a pixel half on 1.0 m and half on 1.5 m mixes their returns") {
  const Engine engine = both_engines();
  const auto [name, stated_m, stated_ratio] = GENERATE(table<std::string, double, double>(
      {{"mixed_equal", 1.250000, 0.978117}, {"mixed_inverse_square", 1.152630, 0.708778}}));
  const Setup setup = analytic_setup(name);
  const Sensor &sensor = setup.start.sensors[0];
  const Measurement frame = measure(engine, setup);
  REQUIRE(frame.returns[0].distance_m.size() == 3);

  const double far_to_near = name == "mixed_equal" ? 1.0 : 1 / (1.5 * 1.5);
  const auto z = 0.5 * (monostatic_return(1, 1.0, sensor) + monostatic_return(far_to_near, 1.5, sensor));
  const double mixed_m = std::arg(z) / (2 * std::numbers::pi) * sensor.ambiguity_m();
  check_distance(engine, name + ", near only", 1.0, sensor, frame.returns[0].distance_m[0]);
  check_distance(engine, name + ", both", mixed_m, sensor, frame.returns[0].distance_m[1]);
  check_distance(engine, name + ", far only", 1.5, sensor, frame.returns[0].distance_m[2]);
  check_amplitude(engine, name + ", amplitude of both / near", std::abs(z),
                  double{frame.returns[0].amplitude[1]} / frame.returns[0].amplitude[0]);
  check_amplitude(engine, name + ", amplitude of far / near", far_to_near,
                  double{frame.returns[0].amplitude[2]} / frame.returns[0].amplitude[0]);
  CHECK(mixed_m == Approx(stated_m).epsilon(0).margin(0.5e-6));
  CHECK(std::abs(z) == Approx(stated_ratio).epsilon(0).margin(0.5e-6));
}

TEST_CASE("amplitude falls with the square of the distance") {
  const Engine engine = both_engines();
  const Setup setup = analytic_setup("inverse_square");
  const Measurement frame = measure(engine, setup);
  const std::vector<double> depths_m{0.5, 1, 2, 4, 8};
  REQUIRE(frame.returns[0].amplitude.size() == depths_m.size());
  for (std::size_t pixel = 0; pixel < depths_m.size(); ++pixel) {
    const double z_m = depths_m[pixel];
    check_amplitude(engine, fmt::format("inverse square, amplitude at {} m", z_m), 1 / (z_m * z_m),
                    frame.returns[0].amplitude[pixel]);
    check_distance(engine, fmt::format("inverse square, {} m", z_m), z_m, setup.start.sensors[0],
                   frame.returns[0].distance_m[pixel]);
  }
}

TEST_CASE("two equal returns c / (4 f) apart cancel", "[smoke]") {
  const Engine engine = both_engines();
  const Setup setup = analytic_setup("cancel");
  const Measurement frame = measure(engine, setup);
  REQUIRE(frame.returns[0].amplitude.size() == 3);
  const double near_m = 1.0, far_m = near_m + setup.start.sensors[0].ambiguity_m() / 2;
  check_distance(engine, "cancel, near only", near_m, setup.start.sensors[0], frame.returns[0].distance_m[0]);
  check_distance(engine, "cancel, far only", far_m, setup.start.sensors[0], frame.returns[0].distance_m[2]);
  check_amplitude(engine, "cancel, amplitude of far / near", 1.0,
                  double{frame.returns[0].amplitude[2]} / frame.returns[0].amplitude[0]);
  CHECK(frame.coverage[1] == 1);
  CHECK(frame.returns[0].amplitude[1] <
        1e-6 * std::min(frame.returns[0].amplitude[0], frame.returns[0].amplitude[2]));
  // NaN is announced by an amplitude of zero, and by nothing else.
  CHECK(std::isnan(frame.returns[0].distance_m[1]) == (frame.returns[0].amplitude[1] == 0));
  CHECK(std::isnan(frame.returns[0].phase_rad[1]) == (frame.returns[0].amplitude[1] == 0));
}
