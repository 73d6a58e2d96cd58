// Polynomials of the point against the sums over the diodes that they stand for, in double.

#include "engine/light/point_polynomials.h"
#include "tests/support/random_scenes.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace pmdsim {
namespace {

using test::Random;

std::vector<CameraIlluminator> board(bool flat, const Pattern &pattern, Random &random) {
  CameraIlluminator light{};
  for (int i = 0; i < 200; ++i) {
    Diode diode;
    diode.position_m = {random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                        flat ? 0.0 : random.uniform(-0.02, 0.02)};
    diode.axis = {0.0, 0.0, 1.0};
    diode.intensity_w_sr = random.uniform(0.5, 1.0);
    diode.pattern = pattern;
    light.diodes.push_back(diode);
  }
  return {light};
}

SourceGroups groups_of(const std::vector<CameraIlluminator> &lights, const SumModel &model) {
  const std::vector<VisibleBox> visible{{{-1.0, -1.0, 1.5}, {1.0, 1.0, 3.0}}};
  SourceGroups groups = group_diodes(lights, visible, test::wavenumber_20mhz_rad_m);
  choose_polynomials(groups, model, test::wavenumber_20mhz_rad_m);
  return groups;
}

// S_power over the run, for a sample's point and what its surface makes of a diode's place.
double direct(const SourceGroups &groups, const glm::dvec3 &point_m, const glm::dvec4 &surface,
              std::uint32_t power) {
  double sum = 0.0;
  for (std::size_t i = 0; i < groups.diodes.size(); ++i) {
    const glm::dvec3 place_m = groups.positions[i].position_m - groups.runs[0].reference_m;
    const double q = glm::dot(place_m, place_m) - 2.0 * glm::dot(place_m, point_m);
    sum += static_cast<double>(groups.diodes[i].intensity) *
           (surface.w + glm::dot(glm::dvec3(surface), place_m)) * std::pow(q, power);
  }
  return sum;
}

// The same by the polynomials, monomial by monomial in the order of moments.glsl.
double beforehand(const std::vector<float> &words, std::uint32_t dimensions, const glm::dvec3 &point_m,
                  const glm::dvec4 &surface, std::uint32_t power) {
  const auto unit_m = static_cast<double>(words[5]);
  const glm::dvec3 at = point_m / unit_m;
  const std::size_t components = dimensions + 1;
  std::size_t first = 8;
  const auto terms = [&](std::uint32_t n) {
    return dimensions == 2 ? (n + 1) * (n + 2) / 2 : (n + 1) * (n + 2) * (n + 3) / 6;
  };
  for (std::uint32_t degree = 0; degree < power; ++degree)
    first += terms(degree) * components;
  const glm::dvec4 factors(surface.w, unit_m * surface.x, unit_m * surface.y, unit_m * surface.z);
  double sum = 0.0;
  std::size_t term = 0;
  for (std::uint32_t n = 0; n <= power; ++n)
    for (std::uint32_t of_y_and_z = 0; of_y_and_z <= n; ++of_y_and_z)
      for (std::uint32_t l = 0; l <= (dimensions == 3 ? of_y_and_z : 0); ++l, ++term)
        for (std::size_t component = 0; component < components; ++component)
          sum += static_cast<double>(words[first + term * components + component]) *
                 factors[static_cast<int>(component)] * std::pow(at.x, n - of_y_and_z) *
                 std::pow(at.y, of_y_and_z - l) * std::pow(at.z, l);
  return sum * std::pow(unit_m, 2.0 * power);
}

} // namespace

TEST_CASE("Polynomials of the point are the sums over the diodes") {
  Random random(11);
  for (const bool flat : {true, false}) {
    const SumModel model{shader::backscatter_lambert, shader::pattern_isotropic, 0.0, true};
    const SourceGroups groups = groups_of(board(flat, {}, random), model);
    const std::uint32_t dimensions = groups.polynomials.point_dimensions;
    REQUIRE(dimensions == (flat ? 2u : 3u));
    REQUIRE(groups.runs.size() == 1);
    const std::vector<float> words = point_polynomials(groups, model, dimensions);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 point_m(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                               random.uniform(1.5, 3.0));
      const glm::dvec4 surface(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7),
                               random.uniform(-1.0, -0.5), random.uniform(0.5, 3.0));
      for (std::uint32_t power = 0; power < groups.polynomials.powers; ++power) {
        // The terms' sum, all of them taken as positive, as far as q reaches.
        const double most = 200.0 * 4.0 * std::pow(0.01 + 0.2 * glm::length(point_m), power);
        CHECK(std::abs(beforehand(words, dimensions, point_m, surface, power) -
                       direct(groups, point_m, surface, power)) <= 0x1p-24 * most);
      }
    }
  }
}

TEST_CASE("Cosines that differ from diode to diode are left to the loop") {
  Random random(12);
  const Pattern cubed{Pattern::Kind::cosine, 3.0};
  const SumModel model{shader::backscatter_lambert, shader::pattern_power, 3.0, true};
  std::vector<CameraIlluminator> lights = board(true, cubed, random);
  CHECK(groups_of(lights, model).polynomials.point_dimensions == 2);
  SECTION("by their axis") { lights[0].diodes[7].axis = glm::normalize(glm::dvec3(0.1, 0.0, 1.0)); }
  SECTION("by their place along it") {
    for (Diode &diode : lights[0].diodes)
      diode.axis = glm::normalize(glm::dvec3(0.1, 0.0, 1.0));
  }
  CHECK(groups_of(lights, model).polynomials.point_dimensions == 0);
}

TEST_CASE("Few diodes are looped over") {
  const SumModel model{shader::backscatter_lambert, shader::pattern_isotropic, 0.0, true};
  Random random(13);
  std::vector<CameraIlluminator> lights = board(true, {}, random);
  lights[0].diodes.resize(4);
  CHECK(groups_of(lights, model).polynomials.point_dimensions == 0);
}

} // namespace pmdsim
