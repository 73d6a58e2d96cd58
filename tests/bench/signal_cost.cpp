// The cost of frequencies and waveforms: the accumulate pass on scenes/paper_ring.json, in alternation, warm.
// Not a test: times are reported, never asserted. Each variant is compared with the reference before it is
// timed.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/accumulate_times.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

using namespace pmdsim;

namespace {

constexpr int rounds = 9;

struct Variant {
  std::string name;
  std::vector<double> modulation_hz;
  Waveform waveform;
  std::size_t base; // the variant that this one's cost is stated in
};

const std::vector<Variant> variants{
    {"sine, 20 MHz", {20e6}, {}, 0},
    {"sine, 100 MHz", {100e6}, {}, 0},
    {"sine, 20, 60 and 100 MHz", {20e6, 60e6, 100e6}, {}, 0},
    {"three harmonics of 20 MHz", {20e6}, {Waveform::Kind::harmonics, {1, 0, 0.1}}, 0},
    {"square, 20 MHz, 4 taps, without moments", {20e6}, {Waveform::Kind::square, {}}, 0},
};

double largest_error_m(const Setup &setup, Sensor sensor) {
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / 64.0;
  sensor.resolution = {64, 64};
  const reference::Frame truth =
      reference::simulate(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  Simulator simulator(SimulatorOptions{});
  simulator.prepare(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  const Measurement found = simulator.measure();
  double error_m = 0.0;
  for (std::size_t f = 0; f < truth.returns.size(); ++f)
    for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel)
      error_m = std::max(error_m, std::abs(std::remainder(found.returns[f].distance_m[pixel] -
                                                              truth.returns[f].distance_m[pixel],
                                                          sensor.ambiguity_m(f))));
  return error_m;
}

} // namespace

int main() {
  const Setup setup = load_setup(PMDSIM_SCENES "/paper_ring.json");
  std::vector<Simulator> simulators;
  std::vector<double> errors_m;
  for (const Variant &variant : variants) {
    Sensor sensor = setup.start.sensors[0];
    sensor.modulation_hz = variant.modulation_hz;
    sensor.waveform = variant.waveform;
    errors_m.push_back(largest_error_m(setup, sensor));
    simulators.emplace_back(SimulatorOptions{})
        .prepare(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  }
  const std::vector<bench::Times> times = bench::accumulate_times(simulators, rounds);
  fmt::print("{}, {} x {} pixels, {} diodes, {} rounds\n", simulators[0].device().name,
             setup.start.sensors[0].resolution.x, setup.start.sensors[0].resolution.y,
             setup.start.illuminators[0].diodes.size(), rounds);
  fmt::print("{:<42}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "accumulate pass, ms", "median", "min", "max", "times",
             "error um");
  for (std::size_t i = 0; i < variants.size(); ++i)
    fmt::print("{:<42}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>12.3f}\n", variants[i].name, times[i].median_ms,
               times[i].min_ms, times[i].max_ms, times[i].median_ms / times[variants[i].base].median_ms,
               1e6 * errors_m[i]);
}
