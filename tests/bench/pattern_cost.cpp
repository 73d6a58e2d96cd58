// The cost of the diodes' patterns: the accumulate pass on scenes/paper_ring.json, in alternation, warm. Not
// a test: times are reported, never asserted. Each variant is compared with the reference before it is timed.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/accumulate_times.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

using namespace pmdsim;

namespace {

constexpr int rounds = 15;

struct Variant {
  std::string name;
  std::vector<Pattern> patterns; // of the diodes in turn
};

// cos^3 of an angle that is wider across than along, every `step_deg` degrees.
Pattern table(int theta_step_deg, int phi_step_deg) {
  constexpr double degree = std::numbers::pi / 180.0;
  Diagram diagram;
  for (int phi = 0; phi < 360; phi += phi_step_deg)
    diagram.phi_rad.push_back(phi * degree);
  for (int theta = 0; theta <= 90; theta += theta_step_deg) {
    diagram.theta_rad.push_back(theta * degree);
    for (const double phi_rad : diagram.phi_rad) {
      const double order = 3.0 + (diagram.phi_rad.size() > 1 ? std::cos(2.0 * phi_rad) : 0.0);
      diagram.relative.push_back(theta < 90 ? std::pow(std::cos(theta * degree), order) : 0.0);
    }
  }
  return {Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>(diagram)};
}

std::vector<Variant> variants() {
  const Pattern isotropic, third{Pattern::Kind::cosine, 3.0}, real{Pattern::Kind::cosine, 3.5};
  const Pattern axial = table(1, 360), around = table(1, 5);
  return {{"isotropic", {isotropic}},
          {"order 3", {third}},
          {"order 3.5", {real}},
          {"table of 1 degree", {axial}},
          {"table of 1 x 5 degrees", {around}},
          {"all of these in turn", {isotropic, third, real, axial, around}}};
}

Illuminator with_patterns(Illuminator illuminator, const std::vector<Pattern> &patterns) {
  for (std::size_t i = 0; i < illuminator.diodes.size(); ++i)
    illuminator.diodes[i].pattern = patterns[i % patterns.size()];
  return illuminator;
}

double largest_relative_error(const Setup &setup, const Illuminator &illuminator) {
  Sensor sensor = setup.start.sensors[0];
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / 64.0;
  sensor.resolution = {64, 64};
  const reference::Frame truth =
      reference::simulate(setup.start.scene, sensor, {illuminator}, setup.backscatter);
  Simulator simulator{SimulatorOptions{}};
  simulator.prepare(setup.start.scene, sensor, {illuminator}, setup.backscatter);
  const Measurement found = simulator.measure();
  double error = 0.0;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel)
    if (const double expected = truth.returns[0].amplitude[pixel]; expected > 0.0)
      error = std::max(error, std::abs(found.returns[0].amplitude[pixel] / expected - 1.0));
  return error;
}

} // namespace

int main() {
  const Setup setup = load_setup(PMDSIM_SCENES "/paper_ring.json");
  const std::vector<Variant> all = variants();
  std::vector<Simulator> simulators;
  std::vector<double> errors;
  for (const Variant &variant : all) {
    const Illuminator illuminator = with_patterns(setup.start.illuminators[0], variant.patterns);
    errors.push_back(largest_relative_error(setup, illuminator));
    simulators.emplace_back(SimulatorOptions{})
        .prepare(setup.start.scene, setup.start.sensors[0], {illuminator}, setup.backscatter);
  }
  const std::vector<bench::Times> times = bench::accumulate_times(simulators, rounds);
  fmt::print("{}, {} x {} pixels, {} diodes, {} rounds\n", simulators[0].device().name,
             setup.start.sensors[0].resolution.x, setup.start.sensors[0].resolution.y,
             setup.start.illuminators[0].diodes.size(), rounds);
  fmt::print("{:<42}{:>10}{:>10}{:>10}{:>10}{:>14}\n", "accumulate pass, ms", "median", "min", "max", "times",
             "amplitude");
  for (std::size_t i = 0; i < all.size(); ++i)
    fmt::print("{:<42}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>14.1e}\n", all[i].name, times[i].median_ms,
               times[i].min_ms, times[i].max_ms, times[i].median_ms / times[0].median_ms, errors[i]);
}
