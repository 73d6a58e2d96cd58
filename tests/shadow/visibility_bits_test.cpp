// The bits of samples and diodes that the host fills in.

#include "engine/shadow/visibility_bits.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

SourceGroups groups_of(std::uint32_t diodes) {
  SourceGroups groups;
  groups.diode_count = diodes;
  return groups;
}

Sensor small_sensor(std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {5, 3};
  sensor.samples = samples;
  return sensor;
}

} // namespace

TEST_CASE("every sample has a bit for each diode, at first 0") {
  for (const auto &[diodes, words] : {std::pair(1u, 1u), {32u, 1u}, {33u, 2u}, {240u, 8u}, {5000u, 157u}})
    CHECK(no_visibility(small_sensor(3), groups_of(diodes)) == std::vector<std::uint32_t>(15 * 9 * words));
}

TEST_CASE("where all diodes reach all samples no bit beyond the last diode is set") {
  for (const std::uint32_t diodes : {1u, 31u, 32u, 33u, 64u, 240u}) {
    auto bits = no_visibility(small_sensor(2), groups_of(diodes));
    full_visibility(groups_of(diodes), bits);
    const std::size_t words = bits.size() / 60;
    for (std::size_t sample = 0; sample < 60; ++sample)
      for (std::uint32_t bit = 0; bit < 32 * words; ++bit)
        REQUIRE((bits[sample * words + bit / 32] >> bit % 32 & 1u) == (bit < diodes ? 1u : 0u));
  }
  std::vector<std::uint32_t> not_asked_for;
  full_visibility(groups_of(240), not_asked_for);
  CHECK(not_asked_for.empty());
}

TEST_CASE("nothing reaches samples that see nothing") {
  Measurement measurement;
  measurement.sample_pixel_id = {0, 7, 0, 9};
  measurement.sample_visibility = {1, 2, 3, 4, 5, 6, 7, 8};
  clear_unseen(measurement);
  CHECK(measurement.sample_visibility == std::vector<std::uint32_t>{0, 0, 3, 4, 0, 0, 7, 8});
}
