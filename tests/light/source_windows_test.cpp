// How diodes come to the lit pass: windows, bundles, boxes, places and bits.

#include "engine/light/source_windows.h"

#include "tests/support/random_scenes.h"
#include "tests/support/units.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <span>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A cloud, and a second illuminator of three diodes aside.
SourceGroups groups_of(int count, double reach_m, double wavenumber_rad_m) {
  Random random(61);
  std::vector<CameraIlluminator> lights(2);
  for (int i = 0; i < count; ++i) {
    lights[0].diodes.emplace_back();
    lights[0].diodes.back().position_m = reach_m * random.in_box(glm::dvec3(-1), glm::dvec3(1));
  }
  for (int i = 0; i < 3; ++i) {
    lights[1].diodes.emplace_back();
    lights[1].diodes.back().position_m = {1.0 + 0.01 * i, 0.1, -0.2};
  }
  return group_diodes(lights, {{{-0.5, -0.5, 2.0}, {0.5, 0.5, 3.0}}}, wavenumber_rad_m);
}

std::uint32_t diodes_per_run(const SourceGroups &groups) {
  return groups.blocks_per_run * shader::diodes_per_block;
}

// Every run in one window, in order, and no more bundles than there may be.
void check_windows(const std::vector<SourceWindow> &windows, const SourceGroups &groups) {
  REQUIRE(bundles_per_run(groups) * shader::diodes_per_bundle >= diodes_per_run(groups));
  std::uint32_t next_run = 0;
  for (const SourceWindow &window : windows) {
    REQUIRE(window.first_run == next_run);
    REQUIRE(window.last_run > window.first_run);
    REQUIRE(window.last_run <= groups.runs.size());
    next_run = window.last_run;
    REQUIRE(window.bundles == (window.last_run - window.first_run) * bundles_per_run(groups));
    REQUIRE(window.bundles <= shader::bundles_per_window);
  }
  CHECK(next_run == groups.runs.size());
}

// Its bundles hold the run's diodes one after the other.
void check_bundles_of_run(const SourceWindow &window, std::uint32_t run, const SourceGroups &groups) {
  std::uint32_t next = groups.runs[run].first;
  for (std::uint32_t i = 0; i < bundles_per_run(groups); ++i) {
    const auto places = positions_of(window, (run - window.first_run) * bundles_per_run(groups) + i, groups);
    REQUIRE(!places.empty());
    REQUIRE(places.size() <= shader::diodes_per_bundle);
    REQUIRE(places.data() == &groups.positions[next]);
    next += static_cast<std::uint32_t>(places.size());
  }
  REQUIRE(next == groups.runs[run].first + diodes_per_run(groups));
}

bool holds(const shader::DiodeBox &box, const glm::dvec3 &p) {
  return glm::all(glm::lessThanEqual(glm::dvec3(box.low), p)) &&
         glm::all(glm::lessThanEqual(p, glm::dvec3(box.high)));
}

// Checks that a bundle's record is true of each of its diodes; `times` counts those that shine.
void check_bundle(const shader::BundleDiodes &bundle, std::uint32_t bits, const shader::DiodeBox &box,
                  std::span<const SourcePosition> places, std::vector<int> &times) {
  for (std::uint32_t i = 0; i < shader::diodes_per_bundle; ++i) {
    const SourcePosition &place = places[std::min<std::size_t>(i, places.size() - 1)]; // the last one again
    const bool shines = (bits >> i & 1u) != 0;
    REQUIRE(shines == (i < places.size() && place.number != no_id));
    if (shines)
      ++times[place.number];
    const glm::dvec3 from_centre_m(bundle.places[i]);
    REQUIRE(glm::distance(glm::dvec3(bundle.centre) + from_centre_m, place.position_m) <=
            1e-9 + 1e-7 * double(bundle.centre.w));
    for (glm::length_t axis = 0; axis < 3; ++axis)
      REQUIRE(std::abs(from_centre_m[axis]) <= double(bundle.centre.w) * (1.0 + 1e-6));
    REQUIRE(holds(box, place.position_m));
  }
}

void check_diodes(const SourceWindow &window, const SourceGroups &groups, std::vector<int> &times) {
  const WindowDiodes told = diodes_of(window, groups);
  REQUIRE(told.bundles.size() == window.bundles);
  REQUIRE(told.bits.size() == window.bundles);
  for (std::uint32_t b = 0; b < window.bundles; ++b) {
    const auto places = positions_of(window, b, groups);
    check_bundle(told.bundles[b], told.bits[b], told.box, places, times);
  }
}

} // namespace

TEST_CASE("windows hold whole runs and every diode once") {
  for (const int count : {1, 15, 16, 17, 240, 256, 257, 5000})
    for (const double wavenumber_factor : {1.0, 5.0, 100.0})
      for (const double reach_m : {1e-6, 0.15, 1.0}) {
        const SourceGroups groups = groups_of(count, reach_m, wavenumber_factor * wavenumber_20mhz_rad_m);
        const auto windows = plan_windows(groups);
        check_windows(windows, groups);
        std::vector<int> times(groups.diode_count);
        for (const SourceWindow &window : windows) {
          for (std::uint32_t run = window.first_run; run < window.last_run; ++run)
            check_bundles_of_run(window, run, groups);
          check_diodes(window, groups, times);
        }
        CHECK(times == std::vector<int>(groups.diode_count, 1));
      }
}

TEST_CASE("the paper's ring is one window") {
  std::vector<CameraIlluminator> ring(1);
  for (int i = 0; i < 240; ++i) {
    ring[0].diodes.emplace_back();
    const double angle = 2.0 * std::numbers::pi * i / 240;
    ring[0].diodes.back().position_m = {0.146 * std::cos(angle), 0.146 * std::sin(angle), 0};
  }
  const auto groups = group_diodes(ring, {{{-0.2, -0.2, 2.0}, {0.2, 0.2, 2.0}}}, wavenumber_20mhz_rad_m);
  const auto windows = plan_windows(groups);
  REQUIRE(windows.size() == 1);
  CHECK(windows[0].bundles == 8);
  const WindowDiodes diodes = diodes_of(windows[0], groups);
  CHECK(std::popcount(diodes.bits.back()) == 16); // of the last bundle's 32
}

TEST_CASE("without shadows one window is all runs") {
  const SourceGroups groups = groups_of(5000, 1.0, wavenumber_20mhz_rad_m);
  const SourceWindow window = all_runs(groups);
  CHECK(window.first_run == 0);
  CHECK(window.last_run == groups.runs.size());
  CHECK(window.bundles == groups.runs.size() * bundles_per_run(groups));
}

TEST_CASE("a window's box is not much larger than its diodes need") {
  const SourceGroups groups = groups_of(240, 0.15, wavenumber_20mhz_rad_m);
  for (const SourceWindow &window : plan_windows(groups)) {
    const WindowDiodes diodes = diodes_of(window, groups);
    glm::dvec3 low_m(1e9), high_m(-1e9);
    for (const shader::BundleDiodes &bundle : diodes.bundles)
      for (const glm::vec4 &place : bundle.places) {
        low_m = glm::min(low_m, glm::dvec3(bundle.centre) + glm::dvec3(place));
        high_m = glm::max(high_m, glm::dvec3(bundle.centre) + glm::dvec3(place));
      }
    CHECK(glm::distance(glm::dvec3(diodes.box.low), low_m) < 1e-6);
    CHECK(glm::distance(glm::dvec3(diodes.box.high), high_m) < 1e-6);
  }
}
