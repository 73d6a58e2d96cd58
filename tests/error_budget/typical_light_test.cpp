#include "engine/error_budget/typical_light.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace pmdsim;

namespace {

constexpr double wavenumber_rad_m = 2.0 * std::numbers::pi * 20e6 / 299792458.0;

VisibleBox point_at(const glm::dvec3 &place_m) { return {place_m, place_m}; }

const std::vector<VisibleBox> at_2m{point_at({0.0, 0.0, 2.0})};

CameraIlluminator lamp(double phase_rad, const Pattern &pattern = {}) {
  CameraIlluminator light;
  light.diodes.emplace_back().pattern = pattern;
  light.modulation_phase_rad = phase_rad;
  return light;
}

} // namespace

TEST_CASE("one lamp's light does not cancel") {
  CHECK(typical_light({lamp(1.0)}, at_2m, wavenumber_rad_m).condition == Approx(1.0));
}

TEST_CASE("lamps of different phases cancel in part") {
  constexpr double angle_rad = std::numbers::pi / 2.0;
  CHECK(typical_light({lamp(0.0), lamp(angle_rad)}, at_2m, wavenumber_rad_m).condition ==
        Approx(std::numbers::sqrt2));
  CHECK(typical_light({lamp(0.0), lamp(std::numbers::pi)}, at_2m, wavenumber_rad_m).condition > 1e6);
}

TEST_CASE("a beam that looks past a place cancels nothing there") {
  const Pattern beam{Pattern::Kind::cosine, 400.0, nullptr};
  const std::vector<VisibleBox> aside{point_at({1.0, 0.0, 1.0})};
  CHECK(typical_light({lamp(0.0), lamp(std::numbers::pi, beam)}, aside, wavenumber_rad_m).condition ==
        Approx(1.0));
}

TEST_CASE("the condition is that of the place in the middle of all") {
  const CameraIlluminator opposite = lamp(std::numbers::pi, {Pattern::Kind::cosine, 4.0, nullptr});
  const std::vector<VisibleBox> on_axis_and_aside{point_at({0.0, 0.0, 1.0}), point_at({1.0, 0.0, 1.0}),
                                                  point_at({0.0, 1.0, 1.0})};
  // cos^4 of 45 degrees is a quarter.
  CHECK(typical_light({lamp(0.0), opposite}, on_axis_and_aside, wavenumber_rad_m).condition ==
        Approx(1.25 / 0.75));
}

TEST_CASE("where nothing is visible or lit, nothing cancels") {
  CHECK(typical_light({lamp(0.0)}, {}, wavenumber_rad_m).condition == 1.0);
  const Pattern cosine{Pattern::Kind::cosine, 1.0, nullptr};
  CHECK(typical_light({lamp(0.0, cosine)}, {point_at({0.0, 0.0, -1.0})}, wavenumber_rad_m).condition == 1.0);
}

TEST_CASE("beams are as dim as they are at most places, and at nine of ten") {
  // cos^8 is a 16th at 45 degrees, where three of 32 places are, and 2^-8 at 60, where one is.
  std::vector<VisibleBox> places(28, point_at({0.0, 0.0, 1.0}));
  places.insert(places.end(), 3, point_at({1.0, 0.0, 1.0}));
  places.push_back(point_at({std::sqrt(3.0), 0.0, 1.0}));
  const TypicalLight light =
      typical_light({lamp(0.0, {Pattern::Kind::cosine, 8.0, nullptr})}, places, wavenumber_rad_m);
  CHECK(std::abs(light.dimming) < 1e-12);
  CHECK(light.dimming_of_most == Approx(4.0 * std::numbers::ln2));
  CHECK(typical_light({lamp(0.0)}, places, wavenumber_rad_m).dimming_of_most == Approx(0.0).margin(1e-12));
}
