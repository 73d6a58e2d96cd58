// Whether frames have the same bits in the ways to measure them that no option chooses: strips, the width of
// the host's vectors, the host's loops or the shaders. Prints rows of the table of docs/reproducibility.md;
// ends with 1 where the same bits are promised and are not found.

// Code that tests share checks some of it by Catch, whose own main() is not wanted here.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "tests/comparison/frame_bytes.h"
#include "tests/comparison/frame_difference.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/simulator.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <optional>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Frame {
  const char *name;
  const char *of; // the repeatability frame whose scene, sensor and mode it has
  std::uint32_t samples;
  std::optional<double> cosine_order; // of a ring, which the host sums, in place of random diodes
};

const std::array<Frame, 6> frames{{
    {"ring", "pinhole", 1, 1.0},
    {"ring, shadows", "shadows", 1, 1.0},
    {"ring, four samples", "shadows", 2, 1.0},
    {"narrow ring, shadows", "shadows", 1, 4.8},
    {"random diodes", "shadows", 1, std::nullopt},
    {"ring, 10 um", "automatic_shadows_tilted_filled", 1, 1.0},
}};

RepeatabilityFrame made(const Frame &of) {
  RepeatabilityFrame frame = repeatability_frame(of.of);
  frame.sensor.samples = of.samples;
  if (of.cosine_order) {
    frame.illuminator.diodes = light_at(ring(40, 0.12), 0.0, cosine(*of.cosine_order)).diodes;
    frame.illuminator.world_from_illuminator = frame.sensor.world_from_camera;
  }
  return frame;
}

struct Way {
  const char *name;
  bool promised;
  std::function<void(SimulatorOptions &, const Sensor &)> change;
};

void forbid_the_host(PathForms &allowed) {
  allowed.host_raster = allowed.host_sweep = allowed.host_sum = allowed.host_pixels = false;
}

const std::array<Way, 7> ways{{
    {"strips of five rows", true,
     [](SimulatorOptions &options, const Sensor &sensor) {
       options.max_strip_samples = 5 * sensor.resolution.x * sensor.samples * sensor.samples;
     }},
    {"host's vectors of 256 bits", false,
     [](SimulatorOptions &options, const Sensor &) { options.host_vector_bits = 256; }},
    {"host's vectors of 128 bits", false,
     [](SimulatorOptions &options, const Sensor &) { options.host_vector_bits = 128; }},
    {"the host's raster off", true,
     [](SimulatorOptions &options, const Sensor &) { options.allowed.host_raster = false; }},
    {"all by shaders", false,
     [](SimulatorOptions &options, const Sensor &) { forbid_the_host(options.allowed); }},
    {"pairs of floats for doubles", false,
     [](SimulatorOptions &options, const Sensor &) { options.precision = SamplePrecision::double_float; }},
    {"the loop of GPUs", false,
     [](SimulatorOptions &options, const Sensor &) { options.loop = DiodeLoop::looped; }},
}};

std::size_t pixels_apart(const Measurement &a, const Measurement &b) {
  std::size_t apart = 0;
  for (std::size_t f = 0; f < a.returns.size(); ++f)
    for (std::size_t i = 0; i < a.returns[f].distance_m.size(); ++i) {
      const float of_a = a.returns[f].distance_m[i], of_b = b.returns[f].distance_m[i];
      apart += of_a == of_b || (std::isnan(of_a) && std::isnan(of_b)) ? 0u : 1u;
    }
  return apart;
}

// What the table says, which is "same" where all bits are.
std::string told(const Measurement &found, const Measurement &expected, const Sensor &sensor) {
  if (bytes_of(found) == bytes_of(expected))
    return "same";
  const FrameDifference apart = difference(found, expected, sensor);
  const std::size_t pixels = pixels_apart(found, expected);
  if (pixels == 0)
    return "distances equal, others not";
  return fmt::format("{:.1e} m, {} of {}", apart.distance_m, pixels,
                     found.returns.size() * sensor.pixel_count());
}

Measurement measured(const RepeatabilityFrame &frame, const SimulatorOptions &options) {
  Simulator simulator = make_simulator(options);
  return measure(simulator, frame);
}

// Whether what is promised was found.
bool print(const Way &way) {
  bool kept = true;
  fmt::print("| {} | {} |", way.name, way.promised ? "yes" : "no");
  for (const Frame &of : frames) {
    const RepeatabilityFrame frame = made(of);
    SimulatorOptions options;
    options.keep_taps = true;
    const Measurement expected = measured(frame, options);
    way.change(options, frame.sensor);
    const std::string text = told(measured(frame, options), expected, frame.sensor);
    kept = kept && (!way.promised || text == "same");
    fmt::print(" {} |", text);
    std::fflush(stdout);
  }
  fmt::print("\n");
  return kept;
}

} // namespace

int main() {
  try {
    fmt::print("| measured | promised |");
    for (const Frame &frame : frames)
      fmt::print(" {} |", frame.name);
    fmt::print("\n|---|---|{}\n", fmt::join(std::vector<std::string>(frames.size(), "---|"), ""));
    bool kept = true;
    for (const Way &way : ways)
      kept = print(way) && kept;
    return kept ? 0 : 1;
  } catch (const std::exception &error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
