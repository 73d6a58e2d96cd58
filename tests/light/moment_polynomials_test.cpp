// Moments from powers of q against the moments themselves, in double.

#include "engine/light/moment_polynomials.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace pmdsim {
namespace {

using test::wavenumber_20mhz_rad_m;

constexpr std::uint32_t moments = 4;

struct Light {
  std::vector<glm::dvec3> diodes_m; // about the reference, which is the origin
  VisibleBox box;
};

Light ring_before_a_wall(double radius_m, double range_m) {
  Light light;
  for (int i = 0; i < 48; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * (i + 0.5) / 48.0;
    light.diodes_m.push_back(radius_m * glm::dvec3(std::cos(angle_rad), std::sin(angle_rad), 0.0));
  }
  light.box = {{-0.1 * range_m, -0.1 * range_m, range_m}, {0.1 * range_m, 0.1 * range_m, 1.1 * range_m}};
  return light;
}

glm::dvec3 somewhere_in(const VisibleBox &box, std::mt19937 &random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  return box.low_m + (box.high_m - box.low_m) * glm::dvec3(share(random), share(random), share(random));
}

// Moment k over the sum of the weights, w = r^-p.
double direct(const Light &light, const glm::dvec3 &point_m, std::uint32_t p, std::uint32_t k) {
  double moment = 0.0, weights = 0.0;
  for (const glm::dvec3 &diode_m : light.diodes_m) {
    const double r_m = glm::distance(point_m, diode_m), w = std::pow(r_m, -static_cast<double>(p));
    moment += w * std::pow(r_m - glm::length(point_m), k);
    weights += w;
  }
  return moment / weights;
}

double by_powers(const MomentPolynomials &sums, const Light &light, const glm::dvec3 &point_m,
                 std::uint32_t k) {
  const double rho2 = glm::dot(point_m, point_m);
  const auto moment = [&](std::uint32_t of) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < sums.powers; ++i) {
      const glm::vec4 &four = sums.tables[0][shader::largest_powers / 4 * of + i / 4];
      const auto a = static_cast<double>(four[static_cast<int>(i % 4)]);
      for (const glm::dvec3 &diode_m : light.diodes_m)
        sum += a * std::pow((glm::dot(diode_m, diode_m) - 2.0 * glm::dot(point_m, diode_m)) / rho2, i);
    }
    return std::pow(rho2, 0.5 * of) * sum;
  };
  return moment(k) / moment(0);
}

MomentPolynomials sums_of(const Light &light, std::uint32_t p,
                          double wavenumber_rad_m = wavenumber_20mhz_rad_m) {
  const std::vector<PathDifference> reaches{path_difference_of(glm::dvec3(0.0), light.diodes_m, {light.box})};
  return fit_polynomials(reaches, p, moments, wavenumber_rad_m, 1.0);
}

TEST_CASE("Moments follow from sums of powers, whatever powers of 1 / r are in the weights") {
  std::mt19937 random(7);
  for (const std::uint32_t p : {2u, 3u, 5u, 8u})
    for (const double range_m : {0.7, 2.0, 50.0}) {
      const Light light = ring_before_a_wall(0.1, range_m);
      const MomentPolynomials sums = sums_of(light, p);
      INFO("p " << p << ", range " << range_m << " m, powers " << sums.powers);
      REQUIRE(sums.powers > 0);
      double worst_rad = 0.0;
      for (int i = 0; i < 100; ++i) {
        const glm::dvec3 point_m = somewhere_in(light.box, random);
        for (std::uint32_t k = 1; k < moments; ++k) // over k!, as an angle
          worst_rad = std::max(worst_rad,
                               std::abs(by_powers(sums, light, point_m, k) - direct(light, point_m, p, k)) *
                                   std::pow(wavenumber_20mhz_rad_m, k) / std::tgamma(k + 1.0));
      }
      // The sum of the weights, which the moments are divided by, is off itself; but what that does to a
      // small moment is small.
      CHECK(worst_rad <= sums.angle_error_rad + sums.weight_error * 0.05);
      CHECK(sums.angle_error_rad <= 0x1p-24);
      CHECK(sums.weight_error <= 0x1p-23);
    }
}

TEST_CASE("The nearer the light's points, the more powers; none where roots are cheaper") {
  const auto powers_at = [](double range_m) { return sums_of(ring_before_a_wall(0.166, range_m), 2).powers; };
  CHECK(powers_at(50.0) <= powers_at(2.0));
  CHECK(powers_at(2.0) == 4);
  CHECK(powers_at(2.0) < powers_at(0.7));
  CHECK(powers_at(0.17) == 0);
}

TEST_CASE("A tolerance takes fewer powers, whose errors it bounds") {
  const Light light = ring_before_a_wall(0.166, 0.9);
  const std::vector<PathDifference> reaches{path_difference_of(glm::dvec3(0.0), light.diodes_m, {light.box})};
  std::uint32_t last = shader::largest_powers;
  for (const double tolerance : {0.0, 0x1p-17, 0x1p-12}) {
    const MomentPolynomials sums =
        fit_polynomials(reaches, 3, moments, wavenumber_20mhz_rad_m, 1.0, tolerance);
    INFO("tolerance " << tolerance << ", powers " << sums.powers);
    REQUIRE(sums.powers > 0);
    CHECK(sums.powers < last);
    CHECK(sums.weight_error <= std::max(tolerance, 0x1p-23));
    CHECK(sums.angle_error_rad <= std::max(tolerance, 0x1p-24));
    last = sums.powers;
  }
}

TEST_CASE("Tables grow no more than at the nearest place in view") {
  const std::uint32_t p = 23;
  double last = 1.0;
  for (const double range_m : {40.0, 4.0, 2.0}) {
    const Light light = ring_before_a_wall(0.166, range_m);
    const PathDifference reach = path_difference_of(glm::dvec3(0.0), light.diodes_m, {light.box});
    const auto bound = bound_near_polynomials({{reach}}, p, moments, wavenumber_20mhz_rad_m, 0.0);
    REQUIRE(bound);
    INFO("at " << range_m << " m: " << bound->growth);
    CHECK(bound->growth > last);
    // The series of (1 - u)^(-p / 2), all of whose terms are positive, and the interpolation's own.
    const double u = std::max(reach.most_stretch, -reach.least_stretch);
    CHECK(bound->growth < 1.1 * std::pow(1.0 - u, -0.5 * p));
    last = bound->growth;
  }
}

TEST_CASE("Tables for places that are not near keep their errors, and their terms the growth that is told") {
  const Light light = ring_before_a_wall(0.166, 0.2);
  const std::vector<PathDifference> reaches{path_difference_of(glm::dvec3(0.0), light.diodes_m, {light.box})};
  const std::uint32_t p = 3;
  for (const double tolerance : {0.0, 0x1p-18}) {
    const auto bound = bound_near_polynomials(reaches, p, moments, wavenumber_20mhz_rad_m, tolerance);
    REQUIRE(bound);
    double largest = 0.0;
    for (const std::uint32_t powers : near_powers(0)) {
      const auto near =
          fit_near_polynomials(reaches[0], p, moments, wavenumber_20mhz_rad_m, powers, tolerance);
      if (!near)
        continue;
      REQUIRE(near->largest_u > largest); // the longer, the farther it reaches
      largest = near->largest_u;
      for (const double u : {-largest, -0.5 * largest, 0.3 * largest, largest}) {
        double sum = 0.0, terms = 0.0;
        for (std::uint32_t i = 0; i < powers; ++i) {
          const auto a = static_cast<double>(near->table[i / 4][static_cast<int>(i % 4)]);
          sum += a * std::pow(u, i);
          terms += std::abs(a * std::pow(u, i));
        }
        CHECK(std::abs(sum * std::pow(1.0 + u, 0.5 * p) - 1.0) <= bound->weight_error);
        CHECK(terms <= bound->growth * (1.0 + 1e-9));
      }
    }
    CHECK(largest > 0.2);
    CHECK(bound->growth > 1.2);
  }
}

TEST_CASE("A diode in the reference point needs no power of q") {
  Light light = ring_before_a_wall(0.1, 2.0);
  light.diodes_m = {glm::dvec3(0.0)};
  CHECK(sums_of(light, 2).powers == 1);
}

TEST_CASE("A diode in its own reference point beside a ring takes as many powers as it needs itself") {
  const Light ring = ring_before_a_wall(0.166, 2.0);
  const std::vector<glm::dvec3> alone_m{glm::dvec3(0.0)};
  const std::vector<PathDifference> reaches{path_difference_of(glm::dvec3(0.0), ring.diodes_m, {ring.box}),
                                            path_difference_of(glm::dvec3(0.0), alone_m, {ring.box})};
  const MomentPolynomials sums = fit_polynomials(reaches, 2, moments, wavenumber_20mhz_rad_m, 1.0);
  REQUIRE(sums.tables.size() == 2);
  CHECK(sums.powers > 1);
  CHECK(sums.tables[1][0] ==
        glm::vec4(1.0f, 0.0f, 0.0f, 0.0f)); // the weight itself, of which nothing is left out
  CHECK(std::isfinite(sums.growth));
}

TEST_CASE("What rounding grows by is counted against the weights, not against the largest") {
  // Where u reaches far, the terms of (1 + u)^-1 for a negative u are large beside their sum for the
  // positive.
  CHECK(sums_of(ring_before_a_wall(0.166, 0.4), 2).growth > 1.5);
  CHECK(sums_of(ring_before_a_wall(0.1, 50.0), 2).growth < 1.05);
}

TEST_CASE("Weights that leave float's range are not summed by powers") {
  CHECK(sums_of(ring_before_a_wall(100.0, 30000.0), 10).powers == 0);
  CHECK(sums_of(ring_before_a_wall(1e-4, 2e-3), 10).powers == 0);
}

} // namespace
} // namespace pmdsim
