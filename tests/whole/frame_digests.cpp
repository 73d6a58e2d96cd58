// Prints a digest of every bit of many frames, a line each, so that two versions of the program can be told
// apart:
//   frame_digests > before, then of the other version > after, then diff before after
// Frames of mode exact in both precisions and of mode auto, in one strip and in many, in the forms of the
// shaders that this device is given and in those that other devices are.

#include "engine/model/error.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/comparison/variants.h"
#include "tests/support/random_setups.h"
#include "tests/support/simulator.h"

#include <exception>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t random_frames = 48;

struct Frame {
  std::string name;
  Scene scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
  Backscatter backscatter;
  Shadows shadows;
  double max_error_m;
};

std::vector<Frame> frames() {
  std::vector<Frame> result;
  for (const std::string &name : repeatability_frames()) {
    RepeatabilityFrame frame = repeatability_frame(name);
    result.push_back({name,
                      std::move(frame.scene),
                      frame.sensor,
                      {frame.illuminator},
                      Backscatter::lambert,
                      frame.shadows,
                      default_max_error_m});
  }
  for (std::uint32_t seed = 0; seed < random_frames; ++seed) {
    RandomSetup setup = random_setup(seed);
    result.push_back({fmt::format("random_{}", seed), std::move(setup.scene), setup.sensor,
                      std::move(setup.illuminators), setup.backscatter, setup.shadows, setup.max_error_m});
  }
  return result;
}

// FNV-1a, 64 bits.
std::uint64_t digest(const std::string &bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes)
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

std::string result_of(const Frame &frame, const SimulatorOptions &options, const Accuracy &accuracy) {
  try {
    Simulator simulator = make_simulator(options);
    simulator.prepare(frame.scene, frame.sensor, frame.illuminators, frame.backscatter, frame.shadows,
                      accuracy);
    const Measurement measured = simulator.measure();
    return fmt::format("{:016x} {} diodes, claimed {:.17g}, found {:.17g}", digest(bytes_of(measured)),
                       measured.accuracy.diodes, measured.accuracy.claimed_m.value_or(0.0),
                       measured.accuracy.found_m.value_or(0.0));
  } catch (const Error &error) {
    return error.what();
  }
}

void print(const Frame &frame, const Variant &variant, const std::string &way, const Accuracy &accuracy) {
  const std::uint32_t row = frame.sensor.resolution.x * frame.sensor.samples * frame.sensor.samples;
  for (const std::uint32_t strip : {0u, 5 * row}) {
    SimulatorOptions options = keep_everything(strip);
    options.precision = variant.precision;
    options.loop = variant.loop;
    fmt::print("{} {}{}{}: {}\n", frame.name, way, variant.name, strip ? ", strips" : "",
               result_of(frame, options, accuracy));
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char **argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  try {
    for (const Frame &frame : frames()) {
      if (frame.name.find(wanted) == std::string::npos)
        continue;
      for (const Variant &variant : variants) {
        print(frame, variant, "exact fp32", {});
        print(frame, variant, "exact fp64", {.mode = Mode::exact, .precision = Precision::fp64});
        print(frame, variant, "auto",
              {.mode = Mode::automatic, .precision = {}, .max_error_m = frame.max_error_m});
      }
    }
  } catch (const std::exception &error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
