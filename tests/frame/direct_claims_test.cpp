// Pixels that go from records to channels at once, within an error: every pixel's bound holds, and the
// frame's claim and the pixels that are summed again are the same whether the host finds them or the device.

#include "tests/comparison/light_formula.h"
#include "tests/frame/kept_bounds.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A wall, a board that shades it, a floor that light grazes, and nothing on the right. No block of samples
// fits the frame's width and height.
struct Room {
  Scene scene;
  Sensor sensor;
  Illuminator light;
};

Room room(double cosine_order) {
  SceneBuilder builder;
  builder.add_wall({2.0, {}, {-10.0, -10.0}, {0.7, 10.0}});
  builder.add_wall({0.8, {.reflectivity = 0.3}, {0.0, -0.1}, {0.12, 0.08}});
  builder.add_triangle({-3, 0.16, 0.3}, {0, 0.2, 3}, {3, 0.16, 0.3});
  Sensor sensor = wide_sensor();
  sensor.resolution = {61, 45};
  sensor.modulation_hz = {20e6, 31e6};
  return {builder.scene(), sensor, light_at(ring(100, 0.15), 0.0, {Pattern::Kind::cosine, cosine_order})};
}

Accuracy within(double max_error_m, std::optional<Precision> precision = {}) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  accuracy.precision = precision;
  return accuracy;
}

Measurement measured(const Room &room, const Accuracy &accuracy, bool on_host = true,
                     std::string_view record = "to channels at once") {
  SimulatorOptions options;
  options.loop = DiodeLoop::looped; // compiles faster
  options.keep_error_bound = true;
  options.allowed.host_sweep = on_host;
  Simulator simulator = make_simulator(options);
  simulator.prepare(room.scene, room.sensor, {room.light}, Backscatter::lambert, Shadows::automatic,
                    accuracy);
  if (accuracy.mode == Mode::automatic)
    for (const auto &[name, value] : simulator.path())
      if (name == "record")
        REQUIRE(value.find(record) != std::string::npos);
  return simulator.measure();
}

void check_the_same(const Measurement &host, const Measurement &device) {
  CHECK(host.accuracy.claimed_m == device.accuracy.claimed_m);
  CHECK(host.accuracy.claimed_amplitude == device.accuracy.claimed_amplitude);
  CHECK(host.accuracy.unpromised == device.accuracy.unpromised);
  for (std::size_t f = 0; f < host.returns.size(); ++f)
    for (std::size_t i = 0; i < host.range_m.size(); ++i) {
      const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
      REQUIRE(same(host.returns[f].distance_m[i], device.returns[f].distance_m[i]));
      REQUIRE(same(host.returns[f].error_bound_m[i], device.returns[f].error_bound_m[i]));
    }
}

void check_bounds(const std::string &name, const Room &at, std::string_view record) {
  Accuracy precise;
  precise.precision = Precision::fp64;
  const Measurement exact = measured(at, precise), frame = measured(at, within(1e-4), true, record);
  REQUIRE(frame.accuracy.precision == Precision::fp32);
  check_kept_bounds(name, frame, exact);
}

} // namespace

TEST_CASE("every pixel that goes to channels at once keeps its bound") {
  print_heading_of_bounds("records' pixels");
  for (const double order : {1.0, 3.0})
    check_bounds(fmt::format("cos^{}", order), room(order), "to channels at once");
}

TEST_CASE("every pixel of records whose sums are stored keeps its bound") {
  print_heading_of_bounds("records' pixels");
  Room at = room(1.0);
  at.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, 0.1}};
  check_bounds("harmonics", at, "depth");
}

TEST_CASE("every pixel of records whose sums are stored keeps its bound, samples and frequencies", "[long]") {
  print_heading_of_bounds("records' pixels");
  Room at = room(1.0);
  at.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, 0.1}};
  at.sensor.samples = 2;
  check_bounds("harmonics, S = 2", at, "depth");
  at.sensor.samples = 1;
  at.sensor.modulation_hz = {20e6, 21e6, 22e6, 23e6, 24e6, 25e6, 26e6}; // more than one dispatch resolves
  check_bounds("harmonics, seven times", at, "point");
  at.sensor.modulation_hz = {20e6, 31e6};
  at.sensor.samples = 2;
  at.sensor.waveform = {};
  check_bounds("sine, S = 2", at, "depth");
}

TEST_CASE("a bound does not depend on how large all harmonics are together") {
  Room at = room(1.0);
  at.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.2, 0.1}};
  const Measurement once = measured(at, within(1e-4), true, "depth");
  for (double &amplitude : at.sensor.waveform.harmonics)
    amplitude *= 8.0;
  check_the_same(once, measured(at, within(1e-4), true, "depth"));
}

TEST_CASE("the host and the device come to the same claim") {
  const Room at = room(1.0);
  check_the_same(measured(at, within(1e-4)), measured(at, within(1e-4), false));
}

TEST_CASE("the host and the device come to the same claim, also where float is too little", "[long]") {
  const Room at = room(1.0);
  const double less_m = 0.8 * *measured(at, within(1e-5)).accuracy.claimed_m;
  const Measurement with_double = measured(at, within(less_m));
  CHECK(with_double.accuracy.unpromised == 0);
  CHECK(*with_double.accuracy.claimed_m < less_m);
  check_the_same(with_double, measured(at, within(less_m), false));
  const Accuracy in_float = within(less_m, Precision::fp32);
  const Measurement only_float = measured(at, in_float);
  CHECK(only_float.accuracy.unpromised > 0);
  check_the_same(only_float, measured(at, in_float, false));
}
