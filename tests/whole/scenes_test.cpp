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
      {.device = {}, .keep_sample_ids = true, .precision = variant.precision, .loop = variant.loop});
  simulator.prepare(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
  return compare(simulator.measure(), expected, setup.start.scene, sensor);
}

struct Chip {
  std::uint32_t samples, coarser; // pixels are so many times as wide and high
};

// Chips of many samples are coarser, as the reference takes minutes for 1.6 billion terms.
const std::vector<Chip> whole_chips{{1, 1}, {2, 1}, {4, 2}}, coarse_chips{{1, 4}, {2, 4}};

Sensor with_chip(Sensor sensor, const Chip &chip) {
  sensor.resolution /= chip.coarser;
  sensor.pixel_pitch_m *= chip.coarser;
  sensor.samples = chip.samples;
  return sensor;
}

void check_scenes(const std::vector<Chip> &chips) {
  fmt::print("{}", comparison_heading());
  for (const std::string scene : {"paper_ring", "paper_half_ring", "room"}) {
    const Setup setup = load_setup(std::string(PMDSIM_SCENES "/") + scene + ".json");
    for (const Chip &chip : chips) {
      const Sensor sensor = with_chip(setup.start.sensors[0], chip);
      const auto expected =
          reference::simulate(setup.start.scene, sensor, {setup.start.illuminators[0]}, setup.backscatter);
      for (const Variant &variant : variants) {
        const std::string name = fmt::format("{}, S = {}{}", scene, chip.samples, variant.name);
        INFO(name);
        const Comparison comparison = compare_variant(variant, setup, sensor, expected);
        fmt::print("{}", comparison_row(name, comparison));
        check_comparison(comparison, sensor.pixel_count() / 2);
      }
    }
  }
}

} // namespace

TEST_CASE("shipped scenes agree with the reference on coarse chips", "[smoke]") {
  check_scenes(coarse_chips);
}

TEST_CASE("shipped scenes agree with the reference", "[long]") { check_scenes(whole_chips); }
