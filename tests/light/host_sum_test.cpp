// The sum over the sources on the host, in vectors of every width, and on the device, against the reference.

#include "tests/comparison/comparison.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <memory>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Pattern diagram(double theta_step_deg, int thetas, int phis, double first_theta_deg = 0.0) {
  Diagram made;
  for (int i = 0; i < thetas; ++i)
    made.theta_rad.push_back((first_theta_deg + i * theta_step_deg) * degree);
  for (int k = 0; k < phis; ++k)
    made.phi_rad.push_back(k * full_turn_rad / phis);
  for (const double theta : made.theta_rad)
    for (const double phi : made.phi_rad)
      made.relative.push_back(std::pow(0.6 + 0.4 * std::cos(theta), 4) *
                              (1.0 + 0.3 * std::sin(theta) * std::cos(2.0 * phi - 0.4)));
  return {Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>(made)};
}

struct HostCase {
  std::string name;
  std::vector<Illuminator> lights;
};

Illuminator turned(Illuminator light, const glm::dvec3 &axis) {
  for (Diode &diode : light.diodes) {
    diode.axis = glm::normalize(axis);
    diode.across = glm::normalize(glm::cross(glm::dvec3(0.1, 1, 0), diode.axis));
  }
  return light;
}

Illuminator dome(Illuminator light) {
  for (Diode &diode : light.diodes) {
    diode.position_m.z = 0.1 - glm::length(diode.position_m);
    diode.axis = glm::normalize(glm::dvec3(3.0 * diode.position_m.x, 2.0 * diode.position_m.y, 1.0));
    diode.across = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), diode.axis));
  }
  return light;
}

Illuminator joined(Illuminator light, const Illuminator &other) {
  light.diodes.insert(light.diodes.end(), other.diodes.begin(), other.diodes.end());
  return light;
}

bool has_same_bits(const std::vector<float> &a, const std::vector<float> &b) {
  return std::ranges::equal(a, b, {}, std::bit_cast<std::uint32_t, float>,
                            std::bit_cast<std::uint32_t, float>);
}

std::vector<HostCase> host_cases() {
  const Pattern axial = diagram(1.0, 181, 1), around = diagram(1.0, 91, 72);
  const auto places = ring(37, 0.12);
  const Illuminator plain = light_at(places, 0.0, axial);
  return {
      {"in registers", {plain}},
      {"across the view", {turned(plain, {1.0, 0.2, 0.2})}},
      {"to the back", {turned(plain, {0.3, 0.2, -1.0})}},
      {"steps of 0.2 degrees", {light_at(ring(37, 0.03), 0.0, diagram(0.2, 451, 1))}},
      {"steps of 0.02 degrees", {light_at(places, 0.0, diagram(0.02, 4501, 1))}},
      {"nothing about the axis", {light_at(places, 0.0, diagram(1.0, 60, 1, 8.0))}},
      {"a dome", {dome(plain)}},
      {"all around", {turned(light_at(places, 0.0, around), {0.2, -0.1, 1.0})}},
      {"a dome, all around", {dome(light_at(places, 0.0, around))}},
      {"beside cosines",
       {joined(joined(plain, light_at(ring(9, 0.05), 0.0)), light_at(ring(5, 0.08), 0.0, cosine(3.0)))}},
      {"two lights", {plain, light_at(ring(20, 0.05), 0.7, around)}},
  };
}

std::vector<HostCase> cosine_cases() {
  const auto places = ring(37, 0.12);
  const Illuminator plain = light_at(places, 0.0), narrow = light_at(places, 0.0, cosine(3.0));
  return {
      {"isotropic", {plain}},
      {"cosines", {narrow}},
      {"cosines across the view", {turned(narrow, {1.0, 0.2, 0.5})}},
      {"a dome of cosines", {dome(narrow)}},
      {"cosines of two powers", {joined(narrow, light_at(ring(9, 0.05), 0.0, cosine(1.0)))}},
      {"cos^1.7", {light_at(places, 0.0, cosine(1.7))}},
      {"cos^0.6 across the view", {turned(light_at(places, 0.0, cosine(0.6)), {1.0, 0.2, 0.5})}},
      {"a dome of cos^4.8", {dome(light_at(places, 0.0, cosine(4.8)))}},
      {"cos^20", {light_at(places, 0.0, cosine(20.0))}},
      {"cos^2.5 and cos^40",
       {joined(light_at(places, 0.0, cosine(2.5)), light_at(ring(9, 0.05), 0.0, cosine(40.0)))}},
  };
}

// Where it is near, no polynomial stands for some of the roots.
Scene slant_of(bool shaded, double nearness = 1.0) {
  SceneBuilder builder;
  std::vector<glm::dvec3> corners_m{{-3, -3, 2.5}, {3, -3, 1.5}, {3, 3, 1.9}, {-3, 3, 2.9}};
  for (glm::dvec3 &corner_m : corners_m)
    corner_m /= nearness;
  builder.add_mesh(corners_m, {{0, 2, 1}, {0, 3, 2}});
  if (shaded)
    builder.add_wall(
        {1.0 / nearness, {}, {0.05 / nearness, -0.1 / nearness}, {0.2 / nearness, 0.15 / nearness}});
  return builder.scene();
}

Sensor sensor_of(std::uint32_t samples) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {43, 30};
  sensor.samples = samples;
  return sensor;
}

// `bits` of the host's vectors; 0: on the device.
void check_sum(const HostCase &of, std::uint32_t bits, const Scene &scene, const Sensor &sensor,
               Backscatter backscatter, Shadows shadows, const reference::Frame &expected) {
  SimulatorOptions options{.device = {},
                           .max_strip_samples = bits == 256 ? 900u : 0u,
                           .keep_sample_ids = true,
                           .loop = DiodeLoop::looped, // compiles faster
                           .host_vector_bits = bits};
  options.allowed.host_sum = bits > 0;
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, of.lights, backscatter, shadows);
  const auto path = simulator.path();
  const auto sum = std::ranges::find(path, "sum", &std::pair<std::string, std::string>::first);
  REQUIRE(sum != path.end());
  CHECK((sum->second.find("on the host") != std::string::npos) == (bits > 0));
  const Comparison comparison = compare(simulator.measure(), expected, scene, sensor);
  fmt::print(
      "{}", comparison_row(fmt::format("{}, {}", of.name, bits > 0 ? fmt::format("{} bits", bits) : "device"),
                           comparison));
  CHECK(comparison.pixels >= 900);
  CHECK(comparison.distance_max_m <= 0.6e-6);
  CHECK(comparison.amplitude_max_relative <= 5e-6);
}

void check_host_sum(const HostCase &of, Backscatter backscatter, bool shaded, std::uint32_t samples,
                    double nearness = 1.0, bool on_device = false) {
  const Scene scene = slant_of(shaded, nearness);
  const Sensor sensor = sensor_of(samples);
  const Shadows shadows = shaded ? Shadows::automatic : Shadows::off;
  const auto expected = reference::simulate(scene, sensor, of.lights, backscatter, {.shadows = shadows});
  for (const std::uint32_t bits : {512u, 256u, 128u})
    check_sum(of, bits, scene, sensor, backscatter, shadows, expected);
  if (on_device)
    check_sum(of, 0, scene, sensor, backscatter, shadows, expected);
}

void check_strips(const std::vector<HostCase> &cases) {
  const Sensor sensor = sensor_of(1); // whose rows end within vectors
  for (const HostCase &of : cases)
    for (const double nearness : {1.0, 5.0}) {
      INFO(of.name << ", " << nearness << " times as near");
      const Scene scene = slant_of(true, nearness);
      std::vector<Measurement> measured;
      for (const std::uint32_t strip : {0u, 900u, 430u}) {
        Simulator simulator = make_simulator({.device = {}, .max_strip_samples = strip});
        simulator.prepare(scene, sensor, of.lights, Backscatter::lambert, Shadows::automatic);
        measured.push_back(simulator.measure());
        CHECK(has_same_bits(measured.front().returns[0].distance_m, measured.back().returns[0].distance_m));
        CHECK(has_same_bits(measured.front().returns[0].amplitude, measured.back().returns[0].amplitude));
      }
    }
}

std::vector<HostCase> all_cases() {
  std::vector<HostCase> cases = host_cases();
  std::ranges::copy(cosine_cases(), std::back_inserter(cases));
  return cases;
}

} // namespace

TEST_CASE("sources with measured diagrams, summed on the host") {
  fmt::print("{}", comparison_heading());
  for (const HostCase &of : host_cases()) {
    INFO(of.name);
    check_host_sum(of, Backscatter::lambert, false, 1);
  }
}

TEST_CASE("sources with measured diagrams, summed on the host, shadows and samples", "[long]") {
  fmt::print("{}", comparison_heading());
  for (const HostCase &of : host_cases())
    for (const bool shaded : {false, true})
      for (const std::uint32_t samples : {1u, 2u}) {
        INFO(of.name << (shaded ? ", shaded" : ""));
        check_host_sum(of, samples == 1 ? Backscatter::constant : Backscatter::lambert, shaded, samples);
      }
}

TEST_CASE("some of the host's sums do not depend on where strips end") {
  check_strips(every_third(all_cases()));
}

TEST_CASE("the host's sums do not depend on where strips end", "[long]") { check_strips(all_cases()); }

TEST_CASE("samples that not all sources reach, summed on the host") {
  fmt::print("{}", comparison_heading());
  for (const HostCase &of : every_third(cosine_cases())) {
    INFO(of.name);
    check_host_sum(of, Backscatter::lambert, true, 1, 1.0, true);
  }
}

TEST_CASE("samples that not all sources reach, summed on the host, near and far", "[long]") {
  fmt::print("{}", comparison_heading());
  for (const HostCase &of : cosine_cases())
    for (const double nearness : {0.2, 5.0})
      for (const std::uint32_t samples : {1u, 2u}) {
        INFO(of.name << ", " << nearness << " times as near, S = " << samples);
        check_host_sum(of, samples == 1 ? Backscatter::constant : Backscatter::lambert, true, samples,
                       nearness, true);
      }
}
