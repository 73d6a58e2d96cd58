#include "engine/light/source_groups.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const std::vector<VisibleBox> wall_at_2m{{{-0.2, -0.2, 2.0}, {0.2, 0.2, 2.0}}};

std::vector<Diode> ring_of(int count, double radius_m) {
  std::vector<Diode> diodes(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / count;
    diodes[static_cast<std::size_t>(k)].position_m = {radius_m * std::cos(angle), radius_m * std::sin(angle),
                                                      0.0};
  }
  return diodes;
}

std::vector<CameraIlluminator> one(const std::vector<Diode> &diodes) { return {{diodes}}; }

// The diodes of scenes/paper_ring.json.
std::vector<Diode> five_rings() {
  std::vector<Diode> diodes;
  for (int i = 0; i < 5; ++i)
    for (const Diode &diode : ring_of(48, 0.126 + 0.01 * i))
      diodes.push_back(diode);
  return diodes;
}

// How much room the boxes around each bundle's diodes take: the sum of their diagonals.
double bundle_diagonals_m(const std::vector<glm::dvec3> &positions_m) {
  double sum_m = 0.0;
  for (std::size_t first = 0; first < positions_m.size(); first += shader::diodes_per_bundle) {
    glm::dvec3 low_m = positions_m[first], high_m = low_m;
    for (std::size_t i = first; i < std::min(first + shader::diodes_per_bundle, positions_m.size()); ++i) {
      low_m = glm::min(low_m, positions_m[i]);
      high_m = glm::max(high_m, positions_m[i]);
    }
    sum_m += glm::distance(low_m, high_m);
  }
  return sum_m;
}

// The diodes of a run with light, put back to where they stand in the camera frame.
std::vector<glm::dvec3> lit_positions(const SourceGroups &groups) {
  std::vector<glm::dvec3> positions;
  for (const SourceRun &run : groups.runs)
    for (std::uint32_t i = 0; i < groups.blocks_per_run * shader::diodes_per_block; ++i)
      if (const auto &diode = groups.diodes[run.first + i]; diode.intensity > 0.0f)
        positions.push_back(run.reference_m - 0.5 * glm::dvec3(diode.position));
  return positions;
}

} // namespace

TEST_CASE("moments are as many as the remainder asks for") {
  CHECK(largest_term(0.5, 0x1p-26) == 0x1p-26);
  CHECK(largest_term(1e-6, 0x1p-26) == Approx(0x1p-22 * 1e-6));
  CHECK(moments_needed(1e-9, 0x1p-26) == 2); // of the excess something is left, however small
  for (const double remainder : {0x1p-26, 0x1p-45}) {
    CHECK(moments_needed(0.0, remainder) == 1);
    for (const double phase_rad : {1e-9, 1e-3, 0.07, 0.5}) {
      const std::uint32_t k = moments_needed(phase_rad, remainder);
      CHECK(std::pow(phase_rad, k) / std::tgamma(k + 1.0) <= largest_term(phase_rad, remainder));
      if (k > 1)
        CHECK(std::pow(phase_rad, k - 1.0) / std::tgamma(double(k)) > largest_term(phase_rad, remainder));
    }
  }
}

TEST_CASE("the paper's ring is one group around the lens, summed in one run") {
  const auto groups = group_diodes(one(ring_of(240, 0.166)), wall_at_2m, wavenumber_20mhz_rad_m);
  REQUIRE(groups.runs.size() == 1);
  CHECK(glm::length(groups.runs[0].reference_m) < 1e-15);
  CHECK(groups.blocks_per_run == 15);
  CHECK(groups.diodes.size() == 240);
  CHECK(groups.moments == 4);
}

TEST_CASE("a group is cut into runs of equal length, of as many blocks as may be at most") {
  const auto cut = [](int diodes, std::uint32_t most_blocks) {
    const auto groups = group_diodes(one(ring_of(diodes, 0.166)), wall_at_2m, wavenumber_20mhz_rad_m,
                                     Precision::fp32, most_blocks);
    CHECK(groups.diodes.size() == groups.runs.size() * groups.blocks_per_run * shader::diodes_per_block);
    return std::pair(groups.runs.size(), groups.blocks_per_run);
  };
  CHECK(cut(960, usual_run_blocks) == std::pair(std::size_t{4}, 15u));
  CHECK(cut(960, long_run_blocks) == std::pair(std::size_t{1}, 60u));
  CHECK(cut(1030, long_run_blocks) == std::pair(std::size_t{2}, 33u));
  CHECK(cut(240, long_run_blocks) == std::pair(std::size_t{1}, 15u));
}

TEST_CASE("the remainder is within its bound over everything visible") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const auto somewhere = [&] { return glm::dvec3(place(random), place(random), place(random)); };
  for (int repetition = 0; repetition < 50; ++repetition) {
    const double wavenumber_rad_m = std::exp2(6 * place(random));
    std::vector<VisibleBox> visible;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 centre_m = somewhere() + glm::dvec3(0, 0, 2.5);
      const glm::dvec3 half_m = 0.4 * glm::abs(somewhere());
      visible.push_back({centre_m - half_m, centre_m + half_m});
    }
    std::vector<Diode> diodes(40);
    for (Diode &diode : diodes)
      diode.position_m = 0.2 * somewhere();
    const auto groups = group_diodes(one(diodes), visible, wavenumber_rad_m);
    double largest_phase_rad = 0.0;
    for (const SourceRun &run : groups.runs)
      for (std::uint32_t i = 0; i < groups.blocks_per_run * shader::diodes_per_block; ++i)
        for (const VisibleBox &box : visible) {
          if (groups.diodes[run.first + i].intensity == 0.0f)
            continue;
          const glm::dvec3 diode_m =
              run.reference_m - 0.5 * glm::dvec3(groups.diodes[run.first + i].position);
          const glm::dvec3 point_m = glm::mix(box.low_m, box.high_m, 0.5 + 0.5 * somewhere());
          const double path_difference_m =
              glm::distance(point_m, diode_m) - glm::distance(point_m, run.reference_m);
          largest_phase_rad = std::max(largest_phase_rad, wavenumber_rad_m * std::abs(path_difference_m));
        }
    CHECK(largest_phase_rad <= 0.5);
    CHECK(std::pow(largest_phase_rad, groups.moments) / std::tgamma(groups.moments + 1.0) <= 0x1p-26);
  }
}

TEST_CASE("every diode is in exactly one group, wherever the groups are cut") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (const int count : {1, 2, 17, 256, 257, 1000}) {
    std::vector<Diode> diodes(static_cast<std::size_t>(count));
    for (Diode &diode : diodes)
      diode.position_m = {place(random), place(random), 0.1 * place(random)};
    const auto groups = group_diodes(one(diodes), wall_at_2m, 100 * wavenumber_20mhz_rad_m);
    auto found = lit_positions(groups);
    REQUIRE(found.size() == diodes.size());
    for (const Diode &diode : diodes) {
      const auto near = [&](const glm::dvec3 &p) { return glm::distance(p, diode.position_m) < 1e-7; };
      const auto match = std::find_if(found.begin(), found.end(), near);
      REQUIRE(match != found.end());
      found.erase(match);
    }
  }
}

TEST_CASE("groups shrink with the wavelength and with what is near") {
  const auto diodes = ring_of(240, 0.166);
  const auto far = group_diodes(one(diodes), wall_at_2m, wavenumber_20mhz_rad_m);
  const auto fast = group_diodes(one(diodes), wall_at_2m, 100 * wavenumber_20mhz_rad_m);
  const auto near = group_diodes(one(diodes), {{{-0.2, -0.2, 0.1}, {0.2, 0.2, 0.1}}}, wavenumber_20mhz_rad_m);
  CHECK(fast.runs.size() > far.runs.size());
  CHECK(near.runs.size() > far.runs.size());
  CHECK(fast.moments <= moments_needed(0.5, largest_remainder(Precision::fp32)));
}

TEST_CASE("many lonely diodes beside a cluster are not padded to the cluster's size") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::vector<Diode> diodes(100000);
  for (std::size_t i = 0; i < diodes.size(); ++i) {
    const double reach_m = i < 60000 ? 0.005 : 0.2; // the others stand on the wall itself
    diodes[i].position_m = {reach_m * place(random), reach_m * place(random), i < 60000 ? 0.0 : 2.0};
  }
  const auto groups = group_diodes(one(diodes), wall_at_2m, wavenumber_20mhz_rad_m);
  CHECK(lit_positions(groups).size() == diodes.size());
  CHECK(groups.diodes.size() < 20 * diodes.size());
}

TEST_CASE("a diode on its own needs no correction of its path") {
  const auto groups = group_diodes(one(ring_of(1, 3.0)), wall_at_2m, wavenumber_20mhz_rad_m);
  CHECK(groups.moments == 1);
  CHECK(groups.diodes[0].position == glm::vec4(0.0f));
}

TEST_CASE("intensities are relative to the largest; dark light stays finite") {
  auto diodes = ring_of(2, 0.1);
  diodes[0].intensity_w_sr = 1e30;
  diodes[1].intensity_w_sr = 5e29;
  const auto groups = group_diodes(one(diodes), wall_at_2m, wavenumber_20mhz_rad_m);
  CHECK(groups.largest_intensity_w_sr == 1e30);
  CHECK(groups.diodes[0].intensity + groups.diodes[1].intensity == Approx(1.5f));
  diodes[0].intensity_w_sr = diodes[1].intensity_w_sr = 0.0;
  CHECK(group_diodes(one(diodes), wall_at_2m, wavenumber_20mhz_rad_m).diodes[0].intensity == 0.0f);
}

TEST_CASE("groups never mix illuminators, and each has its illuminator's phase") {
  // Two rings on top of each other, which as one illuminator are one group.
  const auto both = [](double phase_rad) {
    return std::vector<CameraIlluminator>{{ring_of(20, 0.1), 0.0}, {ring_of(20, 0.1), phase_rad}};
  };
  const auto groups = group_diodes(both(0.75 * std::numbers::pi), wall_at_2m, wavenumber_20mhz_rad_m);
  REQUIRE(groups.runs.size() == 2);
  CHECK(groups.phased);
  CHECK(groups.runs[0].phase_turns == 0.0);
  CHECK(groups.runs[1].phase_turns == Approx(0.375));
  CHECK(lit_positions(groups).size() == 40);
  const auto far_turns = group_diodes(both(-601.5 * std::numbers::pi), wall_at_2m, wavenumber_20mhz_rad_m);
  CHECK(far_turns.runs[1].phase_turns == Approx(0.25).epsilon(1e-12));
  CHECK_FALSE(group_diodes(both(0.0), wall_at_2m, wavenumber_20mhz_rad_m).phased);
}

TEST_CASE("intensities are relative to the largest of all illuminators") {
  std::vector<CameraIlluminator> lights{{ring_of(1, 0.1), 0.0}, {ring_of(1, 0.2), 0.0}};
  lights[1].diodes[0].intensity_w_sr = 4.0;
  const auto groups = group_diodes(lights, wall_at_2m, wavenumber_20mhz_rad_m);
  CHECK(groups.largest_intensity_w_sr == 4.0);
  CHECK(groups.diodes[groups.runs[0].first].intensity == 0.25f);
  CHECK(groups.diodes[groups.runs[1].first].intensity == 1.0f);
}

TEST_CASE("places name every diode of all illuminators once, and stand beside what the sum reads") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (const int count : {1, 15, 16, 17, 33, 257, 1000}) {
    std::vector<CameraIlluminator> lights{{ring_of(count, 0.1)}, {ring_of(3, 0.2)}, {ring_of(count, 0.3)}};
    for (Diode &diode : lights[2].diodes)
      diode.position_m = {place(random), place(random), 0.1 * place(random)};
    std::vector<glm::dvec3> positions_m;
    for (const CameraIlluminator &light : lights)
      for (const Diode &diode : light.diodes)
        positions_m.push_back(diode.position_m);
    const auto groups = group_diodes(lights, wall_at_2m, 30 * wavenumber_20mhz_rad_m);
    REQUIRE(groups.diode_count == positions_m.size());
    REQUIRE(groups.positions.size() == groups.diodes.size());
    std::vector<int> times(positions_m.size());
    for (const SourceRun &run : groups.runs)
      for (std::uint32_t i = run.first; i < run.first + groups.blocks_per_run * shader::diodes_per_block;
           ++i) {
        const SourcePosition &at = groups.positions[i];
        REQUIRE((at.number == no_id) == (groups.diodes[i].intensity == 0.0f));
        if (at.number == no_id)
          continue;
        REQUIRE(at.number < positions_m.size());
        ++times[at.number];
        REQUIRE(at.position_m == positions_m[at.number]);
        REQUIRE(glm::distance(run.reference_m - 0.5 * glm::dvec3(groups.diodes[i].position), at.position_m) <
                1e-6);
      }
    CHECK(times == std::vector<int>(positions_m.size(), 1));
  }
}

TEST_CASE("diodes that share a bundle stand together") {
  const std::vector<Diode> rings = five_rings();
  const auto groups = group_diodes(one(rings), wall_at_2m, wavenumber_20mhz_rad_m);
  std::vector<glm::dvec3> as_given_m, as_grouped_m;
  for (const Diode &diode : rings)
    as_given_m.push_back(diode.position_m);
  for (const SourcePosition &place : groups.positions)
    as_grouped_m.push_back(place.position_m);
  CHECK(bundle_diagonals_m(as_grouped_m) < 0.6 * bundle_diagonals_m(as_given_m));
}
