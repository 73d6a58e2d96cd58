// Few weighted diodes in place of many: the error against the sum over all, in long double, is within the
// bound.

#include "engine/reduction/reduced_set.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

using namespace pmdsim;
using test::cosine;

namespace {

using Light = std::vector<CameraIlluminator>;
using Boxes = std::vector<VisibleBox>;
using Real = long double;

std::vector<Diode> rings(int count, double from_deg = -180.0, double to_deg = 180.0) {
  std::vector<Diode> diodes;
  for (const double radius_m : {0.126, 0.136, 0.146, 0.156, 0.166})
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * ((k + 0.5) / count - 0.5);
      if (const double deg = angle * 180.0 / std::numbers::pi; deg >= from_deg && deg <= to_deg)
        diodes.emplace_back().position_m = {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0};
    }
  return diodes;
}

std::vector<Diode> scattered(int count, const glm::dvec3 &half_m) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::vector<Diode> diodes(static_cast<std::size_t>(count));
  for (Diode &diode : diodes) {
    diode.position_m = half_m * glm::dvec3(place(random), place(random), place(random));
    diode.intensity_w_sr = 1.5 + place(random);
  }
  return diodes;
}

std::vector<Diode> disc(int count, double radius_m) { // Fibonacci's spiral
  std::vector<Diode> diodes(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double r_m = radius_m * std::sqrt((k + 0.5) / count),
                 angle = std::numbers::phi * 2.0 * std::numbers::pi * k;
    diodes[static_cast<std::size_t>(k)].position_m = {r_m * std::cos(angle), r_m * std::sin(angle), 0.0};
  }
  return diodes;
}

std::vector<Diode> with(std::vector<Diode> diodes, const Pattern &pattern,
                        const glm::dvec3 &axis = glm::dvec3(0, 0, 1)) {
  for (Diode &diode : diodes) {
    diode.pattern = pattern;
    diode.axis = glm::normalize(axis);
  }
  return diodes;
}

std::vector<Diode> turned(std::vector<Diode> diodes, const glm::dmat3 &rotation) {
  for (Diode &diode : diodes) {
    diode.position_m = rotation * diode.position_m;
    diode.axis = rotation * diode.axis;
  }
  return diodes;
}

Boxes wall(double half_m, double z_m) { return {{{-half_m, -half_m, z_m}, {half_m, half_m, z_m}}}; }

// A back wall, a floor and a block, as wide as scenes/room.json.
Boxes room() {
  Boxes boxes{{{-0.3, 0.3, 2.0}, {0.3, 1.1, 2.6}}};
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      boxes.push_back({{-2.3 + 0.23 * i, -2.3 + 0.23 * j, 4.0}, {-2.07 + 0.23 * i, -2.07 + 0.23 * j, 4.0}});
  for (int i = 0; i < 10; ++i) {
    const double z_m = 2.0 + 0.2 * i;
    boxes.push_back({{-0.577 * z_m, 1.1, z_m}, {0.577 * z_m, 1.1, z_m + 0.2}});
  }
  return boxes;
}

struct Sample {
  glm::dvec3 point_m, normal; // towards the light
};

// The sum over samples and diodes of what returns, and that of the absolute values.
struct Sum {
  std::complex<Real> value = 0;
  Real terms = 0;

  Real condition() const { return terms / std::abs(value); }
};

Real relative_intensity(const Pattern &pattern, Real cos_theta) {
  if (pattern.kind == Pattern::Kind::isotropic)
    return 1;
  if (pattern.kind == Pattern::Kind::cosine)
    return cos_theta > 0 ? std::pow(cos_theta, Real(pattern.order)) : 0;
  return std::exp(-3 * (1 - cos_theta)); // some measured diagram
}

Sum sum_of(const Light &light, const std::vector<Sample> &samples, bool lambert, double wavenumber_rad_m) {
  using Vector = glm::tvec3<Real>;
  Sum sum;
  for (const auto &[point_m, normal] : samples)
    for (const CameraIlluminator &illuminator : light)
      for (const Diode &diode : illuminator.diodes) {
        const Vector way = Vector(diode.position_m) - Vector(point_m);
        const Real r = glm::length(way), slant = glm::dot(Vector(normal), way) / r;
        Real term = diode.intensity_w_sr / (r * r);
        term *= relative_intensity(diode.pattern, -glm::dot(Vector(diode.axis), way) / r);
        term *= lambert ? std::max<Real>(0, slant) : (slant > 0 ? 1 : 0);
        sum.terms += term;
        sum.value += std::polar(term, wavenumber_rad_m * (r + glm::length(Vector(point_m))) +
                                          Real(illuminator.modulation_phase_rad));
      }
  return sum;
}

bool is_in_front(const VisibleBox &box, const Sample &sample) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p_m =
        glm::mix(box.low_m, box.high_m, glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
    if (glm::dot(sample.normal, p_m - sample.point_m) < 0.0)
      return false;
  }
  return true;
}

// Somewhere in a box, at its corners as often as inside; the surface as slanted as the bound allows as often
// as not.
std::optional<Sample> random_sample(std::mt19937 &random, const Boxes &visible, const VisibleBox &lights) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto triple = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  const VisibleBox &box = visible[random() % visible.size()];
  const glm::dvec3 place = random() % 2 == 0 ? triple() : glm::round(triple());
  Sample sample{glm::mix(box.low_m, box.high_m, place), {}};
  const glm::dvec3 facing = glm::normalize(0.5 * (lights.low_m + lights.high_m) - sample.point_m);
  sample.normal = facing;
  if (!is_in_front(lights, sample))
    return std::nullopt;
  const glm::dvec3 slanted = glm::normalize(2.0 * triple() - 1.0);
  double in_front = 0.0, behind = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (in_front + behind);
    sample.normal = glm::normalize(glm::mix(facing, slanted, middle));
    (is_in_front(lights, sample) ? in_front : behind) = middle;
  }
  const double part = random() % 2 == 0 ? 1.0 : unit(random);
  sample.normal = glm::normalize(glm::mix(facing, slanted, part * in_front));
  return sample;
}

struct Found {
  Real distance_m = 0, amplitude = 0; // over the condition, the largest
  Real of_bound = 0;                  // the largest share of what is claimed
};

// The largest error over points, and over pixels with some samples, at random.
Found largest_error(const Light &light, const ReducedLight &reduced, const Boxes &visible, bool lambert,
                    double wavenumber_rad_m) {
  std::mt19937 random(11);
  std::size_t diodes = 0;
  for (const CameraIlluminator &illuminator : light)
    diodes += illuminator.diodes.size();
  const std::size_t trials = std::min<std::size_t>(600, 3000000 / diodes);
  Found found;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < (trial % 4 == 0 ? 5 : 1); ++i)
      if (const auto sample = random_sample(random, visible, reduced.lights))
        samples.push_back(*sample);
    if (samples.empty())
      continue;
    const Sum all = sum_of(light, samples, lambert, wavenumber_rad_m);
    const Sum few = sum_of(reduced.illuminators, samples, lambert, wavenumber_rad_m);
    const Real condition = all.condition();
    const Real distance_m = std::abs(std::arg(few.value / all.value)) / (2 * wavenumber_rad_m);
    const Real amplitude = std::abs(std::abs(few.value) / std::abs(all.value) - 1);
    const Real relative = reduced.amplitude_error_per_condition * condition;
    if (relative >= 1)
      continue;
    const Real claimed_m = reduced.error_per_condition_m * condition / (1 - relative);
    found.distance_m = std::max(found.distance_m, distance_m / condition);
    found.amplitude = std::max(found.amplitude, amplitude / condition);
    found.of_bound =
        std::max({found.of_bound, (distance_m - 1e-15L) / claimed_m, (amplitude - 1e-15L) / relative});
  }
  return found;
}

struct Case {
  const char *name;
  Light light;
  Boxes visible;
  Backscatter backscatter;
  double modulation_hz, max_error_m;
  std::size_t most_diodes; // that may be left
};

double wavenumber(double modulation_hz) { return 2.0 * std::numbers::pi * modulation_hz / 299792458.0; }

ReducedLight reduced(const Case &c) {
  const double k = wavenumber(c.modulation_hz);
  return reduce_diodes(c.light, c.visible, c.backscatter, {k, k}, c.max_error_m,
                       std::numeric_limits<double>::infinity());
}

std::size_t diodes_of(const Light &light) {
  std::size_t count = 0;
  for (const CameraIlluminator &illuminator : light)
    count += illuminator.diodes.size();
  return count;
}

// A subset in its order, of the same total intensity.
void check_stands_in(const Light &light, const ReducedLight &reduced) {
  REQUIRE(reduced.illuminators.size() == light.size());
  for (std::size_t i = 0; i < light.size(); ++i) {
    const auto &all = light[i].diodes, &few = reduced.illuminators[i].diodes;
    CHECK(reduced.illuminators[i].modulation_phase_rad == light[i].modulation_phase_rad);
    REQUIRE_FALSE(few.empty());
    REQUIRE(few.size() <= all.size());
    double before = 0.0, after = 0.0;
    std::size_t at = 0;
    for (const Diode &diode : few) {
      REQUIRE(diode.intensity_w_sr >= 0.0);
      after += diode.intensity_w_sr;
      while (at < all.size() && all[at].position_m != diode.position_m)
        ++at;
      REQUIRE(at < all.size());
      CHECK(all[at].axis == diode.axis);
      ++at;
    }
    for (const Diode &diode : all) {
      before += diode.intensity_w_sr;
      REQUIRE(glm::clamp(diode.position_m, reduced.lights.low_m, reduced.lights.high_m) == diode.position_m);
    }
    CHECK(after == Approx(before).epsilon(1e-12));
  }
}

const glm::dmat3 tilt = {
    glm::normalize(glm::dvec3(0.9, 0.1, 0.3)),
    glm::normalize(glm::cross(glm::dvec3(-0.3, 0.0, 0.9), glm::dvec3(0.9, 0.1, 0.3))),
    glm::normalize(glm::cross(glm::dvec3(0.9, 0.1, 0.3),
                              glm::cross(glm::dvec3(-0.3, 0.0, 0.9), glm::dvec3(0.9, 0.1, 0.3))))};

std::vector<Diode> mixed() {
  std::vector<Diode> diodes = with(rings(48), cosine(2));
  const auto table = std::make_shared<const Diagram>();
  for (std::size_t i = 0; i < diodes.size(); ++i) {
    if (i % 4 == 1)
      diodes[i].pattern = {};
    if (i % 4 == 2)
      diodes[i].axis = glm::normalize(glm::dvec3(0.2, 0.0, 1.0));
    if (i % 16 == 3)
      diodes[i].pattern = {Pattern::Kind::diagram, 0.0, table};
  }
  return diodes;
}

std::vector<Case> cases() {
  constexpr auto constant = Backscatter::constant, lambert = Backscatter::lambert;
  const Boxes at_2m = wall(0.2, 2.0);
  const Light ring{{rings(48)}}, bar{{scattered(400, {1.0, 0.0, 0.0})}},
      ball{{scattered(500, glm::dvec3(0.1))}};
  const Light two{{rings(48)}, {scattered(60, {0.02, 0.02, 0.0}), 0.8}};
  return {
      {"paper_ring", ring, at_2m, constant, 20e6, 10e-6, 8},
      {"paper_ring", ring, at_2m, constant, 20e6, 1e-6, 12},
      {"paper_ring", ring, at_2m, constant, 20e6, 0.1e-6, 15},
      {"paper_ring", ring, at_2m, lambert, 20e6, 1e-6, 16},
      {"ring of 24,000", {{rings(4800)}}, at_2m, constant, 20e6, 1e-6, 12},
      {"disc of 24,000", {{disc(24000, 0.166)}}, at_2m, constant, 20e6, 1e-6, 12},
      {"half ring", {{rings(48, -90, 90)}}, at_2m, constant, 20e6, 1e-6, 12},
      {"half ring", {{rings(48, -90, 90)}}, at_2m, lambert, 20e6, 1e-6, 16},
      {"room", ring, room(), constant, 20e6, 1e-6, 16},
      {"room", ring, room(), lambert, 20e6, 1e-6, 22},
      {"room", ring, room(), lambert, 20e6, 10e-6, 16},
      {"cos^1", {{with(rings(48), cosine(1))}}, at_2m, lambert, 20e6, 1e-6, 16},
      {"cos^3.5", {{with(rings(48), cosine(3.5))}}, at_2m, lambert, 20e6, 1e-6, 18},
      {"cos^50", {{with(rings(48), cosine(50))}}, at_2m, constant, 20e6, 1e-6, 32},
      {"cos^3, axes tilted", {{with(rings(48), cosine(3), {0.3, 0, 1})}}, at_2m, lambert, 20e6, 1e-6, 20},
      {"tilted plane", {{turned(rings(48), tilt)}}, at_2m, lambert, 20e6, 1e-6, 30},
      {"tilted plane, cos^2", {{turned(with(rings(48), cosine(2)), tilt)}}, at_2m, lambert, 20e6, 1e-6, 40},
      {"bar of 2 m", bar, at_2m, lambert, 20e6, 1e-6, 14},
      {"bar of 2 m, near", bar, wall(0.2, 0.3), lambert, 20e6, 1e-6, 200},
      {"in space", ball, at_2m, lambert, 20e6, 1e-6, 50},
      {"in space, cos^2", {{with(ball[0].diodes, cosine(2))}}, at_2m, constant, 20e6, 1e-6, 50},
      {"mixed diagrams", {{mixed()}}, at_2m, lambert, 20e6, 1e-6, 70},
      {"two with phases", two, at_2m, lambert, 20e6, 1e-6, 30},
      {"paper_ring", ring, at_2m, constant, 1e3, 1e-6, 12},
      {"paper_ring", ring, at_2m, constant, 200e6, 1e-6, 16},
      {"paper_ring", ring, at_2m, lambert, 2e9, 1e-6, 40},
      {"room", ring, room(), lambert, 1e3, 1e-6, 24},
      {"at 0.3 m", ring, wall(0.03, 0.3), lambert, 20e6, 1e-6, 60},
      {"at 0.5 m", ring, wall(0.05, 0.5), lambert, 20e6, 1e-6, 40},
      {"at 100 km", ring, wall(1e4, 1e5), lambert, 20e6, 1e-6, 12},
      {"1 m to 100 km", ring, {{{-0.1, -0.1, 1.0}, {0.1, 0.1, 1e5}}}, constant, 20e6, 1e-6, 40},
  };
}

} // namespace

TEST_CASE("few diodes stand in for many within the bound") {
  std::printf("%-20s %-8s %9s %9s %16s %11s %11s %11s %11s\n", "light", "surface", "Hz", "asked m", "diodes",
              "claimed m", "found m", "claimed |z|", "found |z|");
  for (const Case &c : cases()) {
    INFO(c.name << " " << c.modulation_hz << " Hz, " << c.max_error_m << " m");
    const ReducedLight few = reduced(c);
    check_stands_in(c.light, few);
    const bool lambert = c.backscatter == Backscatter::lambert;
    const Found found = largest_error(c.light, few, c.visible, lambert, wavenumber(c.modulation_hz));
    std::printf("%-20s %-8s %9.1e %9.1e %7zu -> %5zu %11.2e %11.2Le %11.2e %11.2Le\n", c.name,
                lambert ? "lambert" : "constant", c.modulation_hz, c.max_error_m, diodes_of(c.light),
                diodes_of(few.illuminators), few.error_per_condition_m, found.distance_m,
                few.amplitude_error_per_condition, found.amplitude);
    CHECK(few.error_per_condition_m <= c.max_error_m);
    CHECK(few.amplitude_error_per_condition <= 1e-3);
    CHECK(found.of_bound <= 1.0);
    CHECK(diodes_of(few.illuminators) <= c.most_diodes);
  }
}

TEST_CASE("the bound of the paper's ring is not idle") {
  const Case c{"", {{rings(48)}}, wall(0.2, 2.0), Backscatter::constant, 20e6, 1e-6, 0};
  const ReducedLight few = reduced(c);
  CHECK(largest_error(c.light, few, c.visible, false, wavenumber(20e6)).of_bound > 0.5);
}

TEST_CASE("the bound holds at every frequency from the smallest to the largest") {
  const Light light{{rings(48)}, {scattered(50, {0.02, 0.02, 0.0}), 1.0}};
  const ReducedLight few =
      reduce_diodes(light, room(), Backscatter::lambert, {wavenumber(1e5), wavenumber(1e8)}, 1e-5, 1e-3);
  CHECK(diodes_of(few.illuminators) < 60);
  for (const double modulation_hz : {1e5, 1e6, 2e7, 1e8})
    CHECK(largest_error(light, few, room(), true, wavenumber(modulation_hz)).of_bound <= 1.0);
}

TEST_CASE("a smaller relative error of amplitude takes more diodes") {
  const Light light{{rings(48)}};
  const double k = wavenumber(1e3);
  std::size_t last = 0;
  for (const double max_amplitude_error : {1e-3, 1e-5, 1e-8}) {
    const ReducedLight few =
        reduce_diodes(light, room(), Backscatter::constant, {k, k}, 1.0, max_amplitude_error);
    CHECK(few.amplitude_error_per_condition <= max_amplitude_error);
    CHECK(largest_error(light, few, room(), false, k).of_bound <= 1.0);
    CHECK(diodes_of(few.illuminators) > last);
    last = diodes_of(few.illuminators);
  }
}

TEST_CASE("the same light is reduced to the same bits") {
  const Case c{"", {{mixed()}, {disc(5000, 0.1), 1.0}}, room(), Backscatter::lambert, 20e6, 1e-6, 0};
  const ReducedLight first = reduced(c), second = reduced(c);
  REQUIRE(diodes_of(first.illuminators) == diodes_of(second.illuminators));
  CHECK(first.error_per_condition_m == second.error_per_condition_m);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < first.illuminators[i].diodes.size(); ++k) {
      CHECK(first.illuminators[i].diodes[k].position_m == second.illuminators[i].diodes[k].position_m);
      CHECK(first.illuminators[i].diodes[k].intensity_w_sr ==
            second.illuminators[i].diodes[k].intensity_w_sr);
    }
}

TEST_CASE("diodes stay as they are where nothing is known or gained") {
  const auto stays = [](const Light &light, const Boxes &visible) {
    const ReducedLight few = reduced({"", light, visible, Backscatter::lambert, 20e6, 1e-6, 0});
    CHECK(few.error_per_condition_m == 0.0);
    CHECK(few.amplitude_error_per_condition == 0.0);
    CHECK(diodes_of(few.illuminators) == diodes_of(light));
    check_stands_in(light, few);
  };
  auto dark = rings(48);
  for (Diode &diode : dark)
    diode.intensity_w_sr = 0.0;
  const Pattern table{Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>()};
  stays({{rings(48)}}, {});
  const double k = wavenumber(20e6);
  CHECK(
      diodes_of(reduce_diodes({{rings(48)}}, room(), Backscatter::constant, {k, k}, 0.0, 1.0).illuminators) ==
      240);
  stays({{dark}}, wall(0.2, 2.0));
  stays({{with(rings(48), table)}}, wall(0.2, 2.0));
  stays({{std::vector<Diode>(1)}}, wall(0.2, 2.0));
  stays({{rings(1)}}, wall(0.2, 1e-6));
  stays({{scattered(300, {0.1, 0.1, 0.0})}}, {{{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}}}); // among them
  stays({{with(rings(48), cosine(0), {1, 0, 0})}}, wall(0.2, 2.0)); // the wall lies partly behind them
}

TEST_CASE("diodes at one place become one") {
  const Light light{{std::vector<Diode>(100)}};
  const ReducedLight few = reduced({"", light, wall(0.2, 2.0), Backscatter::lambert, 20e6, 1e-12, 0});
  REQUIRE(diodes_of(few.illuminators) == 1);
  CHECK(few.illuminators[0].diodes[0].intensity_w_sr == Approx(100.0));
}

TEST_CASE("what is very bright or very dim is reduced alike") {
  for (const double factor : {1e-30, 1e30}) {
    std::vector<Diode> diodes = rings(48);
    for (Diode &diode : diodes)
      diode.intensity_w_sr = factor;
    const Case c{"", {{diodes}}, wall(0.2, 2.0), Backscatter::constant, 20e6, 1e-6, 0};
    const ReducedLight few = reduced(c);
    check_stands_in(c.light, few);
    CHECK(diodes_of(few.illuminators) <= 12);
  }
}
