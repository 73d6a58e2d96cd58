// The shipped scenes on the Vulkan device against the reference, with the figures of docs/accuracy.md.

#include "host/input/setup/setup.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/variants.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Comparison compare_variant(const Variant &variant, const Setup &setup, const Sensor &sensor,
                           const reference::Frame &expected) {
  Simulator simulator = make_simulator(
      {.device = {}, .keep_sample_tags = true, .precision = variant.precision, .loop = variant.loop});
  simulator.prepare(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  return compare(simulator.measure(), expected, setup.start.scene, sensor);
}

// Of many samples coarser, as the reference takes minutes for 1.6 billion terms.
Sensor with_samples(Sensor sensor, std::uint32_t samples) {
  if (samples > 2) {
    sensor.resolution /= 2u;
    sensor.pixel_pitch_m *= 2.0;
  }
  sensor.samples = samples;
  return sensor;
}

} // namespace

TEST_CASE("shipped scenes agree with the reference") {
  fmt::print("{}", comparison_heading());
  for (const std::string scene : {"paper_ring", "paper_half_ring", "room"}) {
    const Setup setup = load_setup(std::string(PMDSIM_SCENES "/") + scene + ".json");
    for (const std::uint32_t samples : {1u, 2u, 4u}) {
      const Sensor sensor = with_samples(setup.start.sensors[0], samples);
      const auto expected =
          reference::simulate(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
      for (const Variant &variant : variants) {
        const std::string name = fmt::format("{}, S = {}{}", scene, samples, variant.name);
        INFO(name);
        const Comparison comparison = compare_variant(variant, setup, sensor, expected);
        fmt::print("{}", comparison_row(name, comparison));
        check_comparison(comparison, sensor.pixel_count() / 2);
      }
    }
  }
}
