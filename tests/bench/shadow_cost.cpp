// The cost of shadows: every pass of a frame with and without them, in alternation, warm, and the preparation
// of one. Not a test: times are reported, never asserted. A smaller frame of each scene is compared with the
// reference before anything is timed. Scenes may be named to measure only these.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/hills.h"
#include "tests/bench/times.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

struct View {
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
  Backscatter backscatter;
};

struct Case {
  std::string name;
  int rounds;
  std::function<View()> make;
};

View shipped(const std::string &file) {
  const Setup setup = load_setup(PMDSIM_SCENES "/" + file);
  return {setup.start.scene, setup.start.sensors[0], setup.start.illuminators, setup.backscatter};
}

// With the room's camera and light.
View million() {
  View view = shipped("room.json");
  view.scene = bench::hills();
  for (Illuminator &illuminator : view.illuminators)
    illuminator.world_from_illuminator = node_from_camera();
  view.sensor.world_from_camera = node_from_camera();
  return view;
}

const std::vector<Case> cases{
    {"paper_ring", 31, [] { return shipped("paper_ring.json"); }},
    {"room", 15, [] { return shipped("room.json"); }},
    {"bars", 7, [] { return shipped("bars.json"); }},
    {"million", 3, million},
};

// The agreement of the smaller frame with the reference.
struct Agreement {
  std::size_t pairs = 0, different = 0; // a sample and a diode each
  double lit = 0.0;                     // of the pairs
  double error_m = 0.0;                 // of distances where all of a pixel's pairs agree
};

Agreement agreement(const View &view) {
  Sensor sensor = view.sensor;
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / 64.0;
  sensor.resolution = {64, 64};
  sensor.samples = 1;
  const reference::Frame truth = reference::simulate(view.scene, sensor, view.illuminators, view.backscatter,
                                                     {Shadows::automatic, true});
  Simulator simulator({.device = {}, .keep_visibility = true});
  simulator.prepare(view.scene, sensor, view.illuminators, view.backscatter, Shadows::automatic);
  const Measurement found = simulator.measure();
  const std::size_t words = truth.sample_visibility.size() / sensor.pixel_count();
  Agreement result;
  std::size_t reached = 0;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    if (found.triangle_id[pixel] != truth.triangle_id[pixel] || truth.triangle_id[pixel] == no_id)
      continue;
    std::size_t different = 0;
    for (std::size_t i = pixel * words; i < (pixel + 1) * words; ++i) {
      different +=
          static_cast<std::size_t>(std::popcount(found.sample_visibility[i] ^ truth.sample_visibility[i]));
      reached += static_cast<std::size_t>(std::popcount(truth.sample_visibility[i]));
    }
    result.pairs += diode_count(view.illuminators);
    result.different += different;
    if (different == 0 && truth.returns[0].amplitude[pixel] > 0.0)
      result.error_m = std::max(
          result.error_m,
          std::abs(std::remainder(found.returns[0].distance_m[pixel] - truth.returns[0].distance_m[pixel],
                                  sensor.ambiguity_m())));
  }
  result.lit = static_cast<double>(reached) / static_cast<double>(result.pairs);
  return result;
}

double milliseconds(const std::function<void()> &work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

using TimesMs = std::map<std::string, std::vector<double>>; // of a pass, of the frame, of preparing it

constexpr std::array both{Shadows::off, Shadows::automatic};

void prepare(std::span<Simulator> simulators, const View &view, int rounds, std::span<TimesMs> times_ms) {
  for (int round = 0; round <= rounds; ++round) // shaders are compiled in the first
    for (std::size_t i = 0; i < both.size(); ++i)
      times_ms[i][round == 0 ? "prepare, first" : "prepare, again"].push_back(milliseconds([&] {
        simulators[i].prepare(view.scene, view.sensor, view.illuminators, view.backscatter, both[i]);
      }));
}

void measure(std::span<Simulator> simulators, int rounds, std::span<TimesMs> times_ms) {
  for (int round = -1; round < rounds; ++round) // the first is for warming up
    for (std::size_t i = 0; i < both.size(); ++i) {
      const Measurement measurement = simulators[i].measure();
      if (round < 0)
        continue;
      for (const PassTime &pass : measurement.passes)
        times_ms[i][pass.name].push_back(pass.ms);
      times_ms[i]["frame"].push_back(measurement.frame_ms);
    }
}

std::string column(const TimesMs &times_ms, const std::string &name) {
  const auto found = times_ms.find(name);
  if (found == times_ms.end())
    return "";
  const bench::Times times = bench::spread(found->second);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", times.median_ms, times.min_ms, times.max_ms);
}

void report(const Case &scene, const View &view, const Agreement &checked,
            std::span<const TimesMs> times_ms) {
  const auto &[off, automatic] = std::tie(times_ms[0], times_ms[1]);
  fmt::print("\n{}: {} shapes, {} x {} pixels, {} diodes, {} rounds; {:.1f} % of the pairs lit\n", scene.name,
             view.scene.shape_count(), view.sensor.resolution.x, view.sensor.resolution.y,
             diode_count(view.illuminators), scene.rounds, 100.0 * checked.lit);
  fmt::print("against the reference: {} of {} pairs differ, distance to {:.2f} um where none does\n",
             checked.different, checked.pairs, 1e6 * checked.error_m);
  fmt::print("{:<16}{:>32}{:>32}{:>8}\n", "ms", "off", "auto", "times");
  for (const std::string name : {"visibility", "points", "lit", "accumulate", "resolve", "read_back", "frame",
                                 "prepare, first", "prepare, again"}) {
    const bool in_both = off.contains(name) && automatic.contains(name);
    const std::string ratio = in_both ? fmt::format("{:.3f}", bench::spread(automatic.at(name)).median_ms /
                                                                  bench::spread(off.at(name)).median_ms)
                                      : "";
    fmt::print("{:<16}{:>32}{:>32}{:>8}\n", name, column(off, name), column(automatic, name), ratio);
  }
}

void run(const Case &scene) {
  const View view = scene.make();
  const Agreement checked = agreement(view);
  std::array<Simulator, 2> simulators{Simulator{SimulatorOptions{}}, Simulator{SimulatorOptions{}}};
  std::array<TimesMs, 2> times_ms;
  prepare(simulators, view, 3, times_ms);
  measure(simulators, scene.rounds, times_ms);
  report(scene, view, checked, times_ms);
  std::fflush(stdout); // the next may take minutes
}

} // namespace

int main(int count, char **arguments) {
  const std::vector<std::string> wanted(arguments + 1, arguments + count);
  fmt::print("{}\n", Simulator{SimulatorOptions{}}.device().name);
  for (const Case &scene : cases)
    if (wanted.empty() || std::ranges::count(wanted, scene.name) > 0)
      run(scene);
}
