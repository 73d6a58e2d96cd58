// Sums over the sources that are interpolated in cells of the view: every pixel keeps its bound, the same
// bits come of any strips, and setups that it does not suit go another way.

#include "tests/comparison/light_formula.h"
#include "tests/frame/kept_bounds.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A diagram of steps of so many degrees to 90, cos^order but for `part` of it, which varies around the axis.
Pattern diagram_of(double step_deg, double order, double part = 0.0) {
  auto diagram = std::make_shared<Diagram>();
  const double radian = std::numbers::pi / 180.0;
  for (double theta = 0.0; theta < 90.0; theta += step_deg)
    diagram->theta_rad.push_back(theta * radian);
  for (int phi = 0; phi < (part > 0.0 ? 12 : 1); ++phi)
    diagram->phi_rad.push_back(phi * 30.0 * radian);
  for (const double theta : diagram->theta_rad)
    for (const double phi : diagram->phi_rad)
      diagram->relative.push_back(std::pow(std::cos(theta), order) *
                                  (1.0 + part * std::sin(theta) * std::cos(2.0 * phi)));
  return {Pattern::Kind::diagram, 0.0, diagram};
}

// A wall, a board that shades it, a floor that light grazes, a bowl whose triangles are smaller than cells,
// and nothing on the right.
Scene room() {
  SceneBuilder builder;
  builder.add_wall({2.0, {}, {-10.0, -10.0}, {0.5, 10.0}});
  builder.add_wall({1.1, {.reflectivity = 0.3}, {0.0, -0.1}, {0.12, 0.08}});
  builder.add_triangle({-3, 0.5, 0.6}, {0, 0.6, 3}, {3, 0.5, 0.6});
  const auto bowl = [](int i, int k) {
    const glm::dvec2 at = 0.08 * glm::dvec2(i, k);
    return glm::dvec3(at.x - 0.6, at.y - 0.5, 1.9 - 0.8 * glm::dot(at, at));
  };
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      builder.add_triangle(bowl(i, k), bowl(i, k + 1), bowl(i + 1, k));
      builder.add_triangle(bowl(i + 1, k + 1), bowl(i + 1, k), bowl(i, k + 1));
    }
  return builder.scene();
}

struct FieldSetup {
  std::string name;
  std::vector<Illuminator> lights;
  Backscatter backscatter = Backscatter::lambert;
  double max_error_m = 1e-4;
};

FieldSetup lit_by(std::string name, const Pattern &pattern, double max_error_m = 1e-4,
                  double radius_m = 0.15) {
  return {std::move(name), {light_at(ring(240, radius_m), 0.0, pattern)}, Backscatter::lambert, max_error_m};
}

FieldSetup two_boards() {
  FieldSetup setup = lit_by("two boards, 40 degrees apart", diagram_of(1.0, 3.0), 5e-3);
  std::vector<glm::dvec3> beside = ring(80, 0.1);
  for (glm::dvec3 &place_m : beside)
    place_m.x += 0.5;
  setup.lights.push_back(light_at(beside, 0.7, diagram_of(2.0, 2.0)));
  return setup;
}

// A ring, and aside of it one lamp that gives as much light in a narrow beam.
FieldSetup ring_and_spot() {
  FieldSetup setup = lit_by("a ring and a spot", diagram_of(1.0, 3.0), 1e-3);
  Illuminator spot = light_at({{0.3, 0.0, 0.0}}, 0.0, {Pattern::Kind::cosine, 12.0});
  spot.diodes[0].intensity_w_sr *= 240.0;
  setup.lights.push_back(spot);
  return setup;
}

// Two diodes, strong and far from many weak ones, change the field most.
FieldSetup strong_pair() {
  FieldSetup setup = lit_by("many and a strong pair", diagram_of(1.0, 3.0), 1e-3, 0.005);
  const Illuminator pair =
      light_at({{0.0, 0.15, 0.0}, {0.0, -0.15, 0.0}}, 0.0, setup.lights[0].diodes[0].pattern);
  for (Diode diode : pair.diodes) {
    diode.intensity_w_sr *= 240.0;
    setup.lights[0].diodes.push_back(diode);
  }
  return setup;
}

// A lamp that is switched off changes nothing.
FieldSetup one_lamp_off() {
  FieldSetup setup = lit_by("a lamp that is off", diagram_of(1.0, 3.0), 1e-3);
  setup.lights.push_back(light_at(ring(24, 0.1), 0.0, diagram_of(1.0, 3.0)));
  for (Diode &diode : setup.lights[1].diodes)
    diode.intensity_w_sr = 0.0;
  return setup;
}

// Every diode has an axis of its own, up to 20 degrees outwards.
FieldSetup tilted_outwards() {
  FieldSetup setup = lit_by("axes up to 20 degrees outwards", diagram_of(1.0, 3.0), 1e-3);
  for (std::size_t i = 0; i < setup.lights[0].diodes.size(); ++i) {
    Diode &diode = setup.lights[0].diodes[i];
    const double tilt = 0.175 * static_cast<double>(i % 3);
    diode.axis = std::cos(tilt) * diode.axis + std::sin(tilt) * glm::normalize(diode.position_m);
  }
  return setup;
}

FieldSetup flat_backscatter() {
  FieldSetup setup = lit_by("diagram, constant backscatter", diagram_of(1.0, 3.0));
  setup.backscatter = Backscatter::constant;
  return setup;
}

struct FieldFrame {
  Measurement frame;
  std::string sum; // how the path describes it
};

Sensor sensor_of(const glm::uvec2 &resolution) { // 40 x 30 degrees at 200 x 150
  Sensor sensor = wide_sensor();
  sensor.resolution = resolution;
  sensor.pixel_pitch_m *= 0.2;
  sensor.modulation_hz = {20e6};
  return sensor;
}

Simulator prepared_field(const FieldSetup &of, const Scene &scene, const Sensor &sensor,
                         const Accuracy &accuracy, const SimulatorOptions &with) {
  SimulatorOptions options = with;
  options.loop = DiodeLoop::looped; // compiles faster
  options.keep_error_bound = true;
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, of.lights, of.backscatter, Shadows::automatic, accuracy);
  return simulator;
}

std::string sum_of(const Simulator &prepared) {
  for (const auto &[name, value] : prepared.path())
    if (name == "sum")
      return value;
  return {};
}

FieldFrame measured_field(const FieldSetup &of, const Scene &scene, const Sensor &sensor,
                          const Accuracy &accuracy, const SimulatorOptions &with = {}) {
  Simulator simulator = prepared_field(of, scene, sensor, accuracy, with);
  return {simulator.measure(), sum_of(simulator)};
}

FieldFrame measured_field(const FieldSetup &of, const Accuracy &accuracy, const SimulatorOptions &with = {}) {
  return measured_field(of, room(), sensor_of({200, 150}), accuracy, with);
}

Accuracy auto_within(double max_error_m) {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  accuracy.max_error_m = max_error_m;
  return accuracy;
}

bool is_interpolated(const std::string &sum) { return sum.find("nodes") != std::string::npos; }

bool are_same(const Measurement &a, const Measurement &b) {
  const auto same = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  const Return &first = a.returns[0], &second = b.returns[0];
  return std::ranges::equal(first.distance_m, second.distance_m, same) &&
         std::ranges::equal(first.amplitude, second.amplitude, same) &&
         std::ranges::equal(first.error_bound_m, second.error_bound_m, same);
}

void check_kept_amplitudes(const Measurement &frame, const Measurement &exact) {
  const std::vector<float> &is = frame.returns[0].amplitude, &should = exact.returns[0].amplitude;
  for (std::size_t i = 0; i < is.size(); ++i)
    REQUIRE(std::abs(double(is[i]) - double(should[i])) <=
            (*frame.accuracy.claimed_amplitude + 0x1p-23) * double(should[i]));
}

void check_field_bounds(const FieldSetup &of) {
  Accuracy precise;
  precise.precision = Precision::fp64;
  const FieldFrame frame = measured_field(of, auto_within(of.max_error_m));
  INFO(of.name << ": " << frame.sum);
  CHECK(is_interpolated(frame.sum));
  const Measurement exact = measured_field(of, precise).frame;
  check_kept_bounds(of.name, frame.frame, exact);
  check_kept_amplitudes(frame.frame, exact);
}

} // namespace

TEST_CASE("interpolated sums keep every pixel's bound") {
  print_heading_of_bounds("interpolated");
  check_field_bounds(lit_by("diagram, 1 degree", diagram_of(1.0, 3.0)));
}

TEST_CASE("interpolated sums keep every pixel's bound under more kinds of light", "[long]") {
  print_heading_of_bounds("interpolated");
  check_field_bounds(lit_by("cos^33", {Pattern::Kind::cosine, 33.0}, 1e-3));
  check_field_bounds(lit_by("diagram, 3 degrees", diagram_of(3.0, 3.0), 1e-3));
  check_field_bounds(lit_by("diagram with phi", diagram_of(1.0, 3.0, 0.02), 1e-3));
  check_field_bounds(lit_by("a board of 1.2 m", {Pattern::Kind::cosine, 3.5}, 1e-3, 0.6));
  check_field_bounds(ring_and_spot());
  check_field_bounds(tilted_outwards());
  check_field_bounds(strong_pair());
  check_field_bounds(one_lamp_off());
  check_field_bounds(flat_backscatter());
  check_field_bounds(two_boards());
}

TEST_CASE("light that ends between the frame and the last cells' nodes breaks no bound") {
  // The last cells begin with the frame's last 4 columns and rows, and their nodes lie up to 60 samples
  // beyond it. What is visible is known for 16 samples beyond it.
  const Sensor sensor = sensor_of({196, 196});
  const double dark = (98.0 + 30.0) * sensor.pixel_pitch_m.x / sensor.focal_length_m;
  const double ends_deg = std::atan(std::numbers::sqrt2 * dark + 0.015) * 180.0 / std::numbers::pi;
  Pattern pattern = diagram_of(1.0, 3.0);
  auto ends = std::make_shared<Diagram>(*pattern.diagram);
  ends->theta_rad.resize(static_cast<std::size_t>(ends_deg) + 1);
  ends->relative.resize(ends->theta_rad.size());
  pattern.diagram = ends;
  SceneBuilder wall;
  wall.add_wall({2.0, {}, {-10.0, -10.0}, {10.0, 10.0}});
  const FieldSetup of = lit_by("ends beyond the frame", pattern, 1e-4, 0.03);
  const FieldFrame frame = measured_field(of, wall.scene(), sensor, auto_within(1e-4));
  INFO(frame.sum);
  Accuracy precise;
  precise.precision = Precision::fp64;
  check_kept_bounds(of.name, frame.frame, measured_field(of, wall.scene(), sensor, precise).frame);
}

TEST_CASE("interpolated sums have the same bits in any strips, and each vector's width keeps the bound") {
  const FieldSetup of = lit_by("diagram", diagram_of(1.0, 3.0));
  const FieldFrame whole = measured_field(of, auto_within(1e-4));
  REQUIRE(is_interpolated(whole.sum));
  for (const std::uint32_t rows : {7u, 40u}) {
    SimulatorOptions options;
    options.max_strip_samples = rows * 200;
    CHECK(are_same(measured_field(of, auto_within(1e-4), options).frame, whole.frame));
  }
  SimulatorOptions narrow;
  narrow.host_vector_bits = 128;
  check_kept_bounds("vectors of 128 bits", measured_field(of, auto_within(1e-4), narrow).frame,
                    measured_field(of, Accuracy()).frame);
}

TEST_CASE("sums are not interpolated where that does not suit them") {
  const auto is_within = [](const FieldSetup &of, const Accuracy &accuracy, const PathForms &allowed = {}) {
    SimulatorOptions options;
    options.allowed = allowed;
    return is_interpolated(sum_of(prepared_field(of, room(), sensor_of({200, 150}), accuracy, options)));
  };
  const auto is_so = [&](const FieldSetup &of, double max_error_m, const PathForms &allowed = {}) {
    return is_within(of, auto_within(max_error_m), allowed);
  };
  const FieldSetup of = lit_by("diagram", diagram_of(1.0, 3.0));
  REQUIRE(is_so(of, 1e-4));
  CHECK_FALSE(is_so(of, 1e-4, {.incident_field = false}));
  CHECK_FALSE(is_so(of, 2e-6)); // less than nodes' rounding comes to
  CHECK_FALSE(is_within(of, {}));
  CHECK_FALSE(is_so(lit_by("summed beforehand", {Pattern::Kind::cosine, 3.0}), 1e-4));
  FieldSetup few = of;
  few.lights = {light_at(ring(8, 0.15), 0.0, diagram_of(1.0, 3.0))};
  CHECK_FALSE(is_so(few, 1e-4)); // nodes would be dearer than samples
  // A diagram that ends within the view, and one that is dark there.
  auto ends = std::make_shared<Diagram>(*of.lights[0].diodes[0].pattern.diagram);
  ends->theta_rad.resize(20);
  ends->relative.resize(20);
  ends->relative.back() = 0.0;
  CHECK_FALSE(is_so(lit_by("ends", {Pattern::Kind::diagram, 0.0, ends}), 1e-4));
}

TEST_CASE("pixels that see nothing keep every bound") {
  // Without a class in double, pixels that do not keep the bound are counted.
  Accuracy in_float = auto_within(1e-4);
  in_float.precision = Precision::fp32;
  const Measurement frame = measured_field(lit_by("diagram", diagram_of(1.0, 3.0)), in_float).frame;
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < frame.coverage.size(); ++i)
    if (frame.coverage[i] == 0.0f) {
      ++unseen;
      CHECK(!(frame.returns[0].error_bound_m[i] > 0.0f)); // not a number
    }
  CHECK(unseen > 64);
  CHECK(frame.accuracy.unpromised < unseen);
}
