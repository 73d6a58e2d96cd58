// Few diodes that stand in for all of a frame's samples at once, where every diode lights each of them.

#include "tests/comparison/light_formula.h"
#include "tests/frame/kept_bounds.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct NarrowLight {
  double order;
  int diodes;
  Scene scene = wall_at(2.0);
};

// Which sources light each class of pixels.
std::string classes_of(Simulator &simulator) {
  for (const auto &[name, value] : simulator.path())
    if (name == "pixels")
      return value;
  return {};
}

struct LitFrame {
  Measurement measurement;
  std::string classes;
};

LitFrame measured_under(const NarrowLight &of, const Accuracy &accuracy) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {61, 45};
  // With several, a claim may count one's bound of a pixel that another's has summed again.
  sensor.modulation_hz = {20e6};
  SimulatorOptions options;
  options.loop = DiodeLoop::looped; // compiles faster
  options.keep_error_bound = true;
  Simulator simulator = make_simulator(options);
  simulator.prepare(of.scene, sensor,
                    {light_at(ring(of.diodes, 0.15), 0.0, {Pattern::Kind::cosine, of.order})},
                    Backscatter::lambert, Shadows::off, accuracy);
  return {simulator.measure(), classes_of(simulator)};
}

Accuracy automatic_within(double max_error_m) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  return accuracy;
}

// The wall, and a shelf before it that looks past the upper part of the ring.
Scene with_shelf() {
  SceneBuilder builder;
  builder.add_wall({2.0});
  builder.add_triangle({-3, 0.1, 1.0}, {3, 0.1, 1.0}, {0, 0.1, 2.0});
  return builder.scene();
}

} // namespace

TEST_CASE("stand-ins light whole frames, and every pixel keeps its bound") {
  print_heading_of_bounds("stand-ins");
  for (const NarrowLight &of : {NarrowLight{20.0, 240}, NarrowLight{40.0, 240}, NarrowLight{33.5, 600}}) {
    Accuracy precise;
    precise.precision = Precision::fp64;
    const Measurement exact = measured_under(of, precise).measurement,
                      frame = measured_under(of, automatic_within(1e-4)).measurement;
    CHECK(2 * frame.accuracy.diodes <= static_cast<std::uint32_t>(of.diodes));
    check_kept_bounds(fmt::format("cos^{}, {} diodes", of.order, of.diodes), frame, exact);
  }
}

TEST_CASE("nothing stands in for diodes that a surface turns away from") {
  NarrowLight of{40.0, 240};
  const auto classes = [&] { return measured_under(of, automatic_within(1e-4)).classes; };
  CHECK(classes().find("reduced sources") != std::string::npos);
  of.scene = with_shelf();
  CHECK(classes().find("all: reduced sources") == std::string::npos); // a GPU sorts pixels into others
}
