// Forms of a frame's path: one that is forbidden is not taken, and none changes what a frame measures beyond
// its error.

#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double asked_for_m = 1e-3; // of mode auto
constexpr double float_error_m = 2e-6;

struct Form {
  std::string name;
  bool PathForms::*allowed;
  std::uint32_t samples;
  Mode mode;
  std::string of; // the name in the path's description
};

// Each with a frame of a ring before a wall that takes it.
const std::vector<Form> forms{
    {"polynomial moments", &PathForms::polynomial_moments, 1, Mode::exact, "sum"},
    {"equal weights", &PathForms::equal_weights, 1, Mode::exact, "sum"},
    {"coplanar sources", &PathForms::coplanar, 1, Mode::exact, "sum"},
    {"sums over the diodes beforehand", &PathForms::point_polynomials, 1, Mode::exact, "sum"},
    {"direct pixels", &PathForms::direct_pixels, 1, Mode::exact, "record"},
    {"depth records", &PathForms::depth_records, 1, Mode::exact, "record"},
    {"one backscatter", &PathForms::one_backscatter, 1, Mode::exact, "record"},
    {"uniform pixels", &PathForms::uniform_pixels, 2, Mode::automatic, "pixels"},
    {"uniform pixels of one sample", &PathForms::uniform_single_samples, 1, Mode::reduced, "pixels"},
    {"direct pixels within an error", &PathForms::direct_pixels, 1, Mode::automatic, "record"},
    {"refined uniform pixels", &PathForms::refined_uniform_pixels, 2, Mode::automatic, "pixels"},
    {"the raster on the host", &PathForms::host_raster, 1, Mode::exact, "raster"},
    {"the sweep on the host", &PathForms::host_sweep, 1, Mode::exact, "visibility"},
    {"the sum on the host", &PathForms::host_sum, 1, Mode::exact, "sum"},
    {"direct pixels on the host", &PathForms::host_pixels, 1, Mode::exact, "record"},
};

struct Taken {
  Measurement measured;
  std::string description; // of the form
};

Taken take(const Form &form, bool allowed) {
  SimulatorOptions options;
  options.loop = DiodeLoop::looped; // compiles faster
  // These are forms of the device's loop over the diodes, which sums beforehand or by the host do not have.
  const bool of_loop = form.allowed == &PathForms::equal_weights || form.allowed == &PathForms::coplanar;
  options.allowed.point_polynomials = options.allowed.host_sum = !of_loop;
  options.allowed.*form.allowed = allowed;
  Accuracy accuracy;
  accuracy.mode = form.mode;
  accuracy.max_error_m = asked_for_m;
  const bool shaded = form.of == "visibility";
  Pattern pattern;
  if (form.allowed == &PathForms::host_sum)
    pattern = {Pattern::Kind::diagram, 0.0,
               std::make_shared<const Diagram>(Diagram{{0.0, 1.5}, {0.0}, {1.0, 0.1}})};
  SceneBuilder builder;
  builder.add_wall({2.0});
  if (shaded)
    builder.add_wall({1.0, {}, {0.2, -0.1}, {0.4, 0.1}});
  const Scene scene = builder.scene();
  Sensor sensor = wide_sensor();
  sensor.samples = form.samples;
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, {light_at(ring(48, 0.1), 0.0, pattern)}, Backscatter::constant,
                    shaded ? Shadows::automatic : Shadows::off, accuracy);
  const auto path = simulator.path();
  const auto of = std::ranges::find(path, form.of, &std::pair<std::string, std::string>::first);
  REQUIRE(of != path.end());
  return {simulator.measure(), of->second};
}

double largest_change_m(const Measurement &one, const Measurement &other) {
  double largest_m = 0.0;
  for (std::size_t i = 0; i < one.returns[0].distance_m.size(); ++i)
    largest_m = std::max(largest_m, static_cast<double>(std::abs(one.returns[0].distance_m[i] -
                                                                 other.returns[0].distance_m[i])));
  return largest_m;
}

void check_forms(const std::vector<Form> &some) {
  for (const Form &form : some) {
    INFO(form.name);
    const Taken with = take(form, true), without = take(form, false);
    CHECK(with.description != without.description);
    CHECK(largest_change_m(with.measured, without.measured) <=
          (form.mode == Mode::exact ? float_error_m : 2 * asked_for_m));
  }
}

} // namespace

TEST_CASE("some forms of the path that are forbidden are not taken and change nothing else") {
  check_forms(every_third(forms));
}

TEST_CASE("a form of the path that is forbidden is not taken and changes nothing else", "[long]") {
  check_forms(forms);
}
