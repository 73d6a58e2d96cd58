// Which diodes light which sample of the procedural scenes, every pair against the reference.

#include "host/bench/real/scene_files.h"
#include "tests/comparison/visibility_comparison.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <fmt/format.h>
#include <span>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

void check_kind(const SceneKind &kind, std::uint32_t triangles, std::uint32_t columns) {
  INFO(kind.name);
  const Setup setup = setup_of_kind(kind, triangles, columns);
  const auto &[scene, sensors, illuminators, others] = setup.start;
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true, .keep_visibility = true});
  simulator.prepare(scene, sensors[0], illuminators, setup.backscatter, setup.shadows);
  const auto expected =
      reference::simulate(scene, sensors[0], illuminators, setup.backscatter, {Shadows::automatic, true});
  const ReachedComparison reached =
      compare_reached(simulator.measure(), expected, scene, sensors[0], illuminators);
  fmt::print("{}", reached_row(kind.name, reached));
  CHECK(reached.pairs > 0);
  CHECK(reached.clear_of_all == 0);
  CHECK(reached.differing_fraction() <= 1e-6);
  CHECK(reached.lit_error <= 1e-6);
}

} // namespace

TEST_CASE("awkward scenes are shaded as by the reference") {
  fmt::print("{}", reached_heading());
  for (const char *name : {"needles", "fans", "piercing"})
    check_kind(*find_kind(name), 3'000, 32);
}

TEST_CASE("every kind of scene is shaded as by the reference", "[long]") {
  fmt::print("{}", reached_heading());
  for (const SceneKind &kind : scene_kinds())
    check_kind(kind, 10'000, 160);
}
