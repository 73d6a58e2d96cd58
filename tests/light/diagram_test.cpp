// Diodes with measured diagrams.

#include "tests/comparison/light_formula.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <initializer_list>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

std::vector<double> angles(double step_rad, std::size_t count) {
  std::vector<double> angles(count);
  for (std::size_t i = 0; i < count; ++i)
    angles[i] = static_cast<double>(i) * step_rad;
  return angles;
}

Pattern table(const std::vector<double> &theta_rad, const std::vector<double> &phi_rad, const Gain &gain) {
  Diagram diagram{theta_rad, phi_rad, {}};
  for (const double theta : theta_rad)
    for (const double phi : phi_rad)
      diagram.relative.push_back(gain({theta, phi}));
  return {Pattern::Kind::diagram, 0.0, std::make_shared<const Diagram>(diagram)};
}

// Linear between the nodes of an even grid that begins at 0, by the book; phi goes all around.
Gain bilinear(double theta_step_rad, double phi_step_rad, const Gain &gain) {
  return [=](const Angles &angles) {
    const double u = angles.theta_rad / theta_step_rad, v = angles.phi_rad / phi_step_rad;
    const auto node = [&](double i, double k) { return gain({i * theta_step_rad, k * phi_step_rad}); };
    const auto row = [&](double i) {
      return std::lerp(node(i, std::floor(v)), node(i, std::floor(v) + 1), v - std::floor(v));
    };
    return std::lerp(row(std::floor(u)), row(std::floor(u) + 1), u - std::floor(u));
  };
}

// Not the same when it is mirrored.
double ellipse(const Angles &angles) {
  const double across = angles.theta_rad * std::cos(angles.phi_rad) / 0.5;
  const double upright = angles.theta_rad * std::sin(angles.phi_rad) / 0.2;
  return std::exp(-0.5 * (across * across + upright * upright) - upright * (0.3 + 0.1 * across));
}

double cosine3(const Angles &angles) { return std::pow(std::max(0.0, std::cos(angles.theta_rad)), 3); }

} // namespace

TEST_CASE("a table of cos^3 at 1 degree is order 3", "[long]") {
  const auto places = ring(48, 0.166);
  const Pattern order{Pattern::Kind::cosine, 3.0};
  const WallCase by_order{.name = "order 3", .lights = {{light_at(places, 0, order), cosine3}}};
  const Pattern by_degree = table(angles(degree, 91), {0}, cosine3);
  const WallCase by_table{
      .name = "cos^3 at 1 degree",
      .lights = {{light_at(places, 0, by_degree), bilinear(degree, full_turn_rad, cosine3)}}};
  check_wall(by_order);
  check_wall(by_table);
  for (const SimulatorOptions &options : all_variants()) {
    const Measurement expected = measure(by_order, options), measured = measure(by_table, options);
    double distance_m = 0.0, amplitude = 0.0;
    for (std::size_t pixel = 0; pixel < by_table.sensor.pixel_count(); ++pixel) {
      const auto &a = measured.returns[0], &b = expected.returns[0];
      distance_m = std::max(distance_m, std::abs(double(a.distance_m[pixel]) - b.distance_m[pixel]));
      amplitude = std::max(amplitude, std::abs(double(a.amplitude[pixel]) / b.amplitude[pixel] - 1.0));
    }
    CHECK(distance_m <= 1e-6);
    CHECK(amplitude <= 1e-3);
    CHECK(amplitude > 1e-6); // it was the table
  }
}

namespace {

void check_rolled_ellipse(std::initializer_list<double> rolls_deg) {
  const Gain gain = bilinear(degree, 5 * degree, ellipse);
  const Pattern wide_across = table(angles(degree, 181), angles(5 * degree, 72), ellipse);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.2, -0.1, 1.0));
  const glm::dvec3 level = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), axis));
  for (const double roll_deg : rolls_deg) {
    WallCase rolled{.name = fmt::format("ellipse, rolled by {:g} degrees", roll_deg),
                    .lights = {{light_at(ring(20, 0.1), 0, wide_across), gain}}};
    for (Diode &diode : rolled.lights[0].illuminator.diodes) {
      diode.axis = axis;
      diode.across =
          std::cos(roll_deg * degree) * level + std::sin(roll_deg * degree) * glm::cross(axis, level);
    }
    check_wall(rolled);
  }
}

} // namespace

TEST_CASE("an elliptical diagram turns with what lies across the diode's axis") {
  check_rolled_ellipse({30.0});
}

TEST_CASE("an elliptical diagram turns with what lies across the diode's axis, other angles", "[long]") {
  check_rolled_ellipse({0.0, 200.0});
}

TEST_CASE("an elliptical diagram is the ellipse, and wider across") {
  const Pattern wide_across = table(angles(degree, 181), angles(5 * degree, 72), ellipse);
  WallCase rolled{.name = "", .lights = {{light_at({{0, 0, 0}}, 0, wide_across), ellipse}}};
  rolled.lights[0].illuminator.diodes[0].across = {0, 1, 0}; // upright in the image
  const Errors errors = errors_of(rolled, {});
  CHECK(errors.amplitude < 0.03); // of the table: 30 times as bright in one direction as in the other
}

TEST_CASE("phi may begin anywhere") {
  const std::vector<double> phi_rad{40 * degree, 160 * degree, 280 * degree};
  const Gain nodes = [](const Angles &angles) { return 1.0 + 0.5 * std::cos(angles.phi_rad - 70 * degree); };
  const Gain gain = [&](const Angles &angles) {
    const double steps =
        std::fmod(angles.phi_rad - 40 * degree + full_turn_rad, full_turn_rad) / (120 * degree);
    const auto node = [&](double k) { return nodes({0, (40 + 120 * k) * degree}); };
    return std::lerp(node(std::floor(steps)), node(std::floor(steps) + 1), steps - std::floor(steps));
  };
  check_wall({.name = "phi from 40 degrees",
              .lights = {{light_at(ring(5, 0.2), 0, table({0, 2}, phi_rad, nodes)), gain}}});
}

TEST_CASE("a diagram with a hole on its axis") {
  // Nothing below 10 degrees, there all at once 1, and nothing beyond 25 degrees.
  const Gain gain = [](const Angles &angles) {
    return angles.theta_rad < 10 * degree || angles.theta_rad > 25 * degree
               ? 0.0
               : 1.0 - 0.5 * (angles.theta_rad - 10 * degree) / (15 * degree);
  };
  WallCase hole{
      .name = "a hole on the axis",
      .lights = {{light_at({{0.05, 0, 0}}, 0, table({10 * degree, 25 * degree}, {0}, gain)), gain}}};
  hole.left_out = [&](const glm::dvec3 &point_m) {
    const double theta_rad = angles_of(point_m - glm::dvec3(0.05, 0, 0), Diode()).theta_rad;
    return std::min(std::abs(theta_rad - 10 * degree), std::abs(theta_rad - 25 * degree)) < 1e-6;
  };
  check_wall(hole);
  CHECK(measure(hole, {}).returns[0].amplitude[24 * 64 + 32] == 0.0f);
}

TEST_CASE("a beam of one degree") {
  const Gain narrow = [](const Angles &angles) { return std::exp(-std::pow(angles.theta_rad / 0.004, 2)); };
  WallCase beam{.name = "a beam of one degree",
                .lights = {{light_at(ring(16, 0.01), 0, table(angles(0.02 * degree, 101), {0}, narrow)),
                            bilinear(0.02 * degree, full_turn_rad, narrow)}}};
  beam.sensor.pixel_pitch_m = glm::dvec2(2.5e-4); // 0.9 degrees
  check_wall(beam, 1e-4);
}

TEST_CASE("straight behind a diode a frame has what a diagram of all angles says") {
  const Gain behind = [](const Angles &angles) { return angles.theta_rad > 90 * degree ? 0.25 : 1.0; };
  const Pattern all_around = table({0, 80 * degree, 100 * degree, 180 * degree}, {0}, behind);
  WallCase away{.name = "light to all sides, turned away",
                .sensor = axial_sensor({16, 16}),
                .lights = {{light_at({{0, 0, 0}}, 0, all_around), behind}}};
  away.lights[0].illuminator.diodes[0].axis = {0, 0, -1};
  check_wall(away);
}

TEST_CASE("every kind of pattern in one light") {
  WallCase mixed{.name = "patterns of all kinds"};
  const Gain flat = [](const Angles &angles) { return 1.0 - angles.theta_rad / 2.0; };
  const std::vector<std::pair<Pattern, Gain>> kinds{
      {{}, [](const Angles &) { return 1.0; }},
      {{Pattern::Kind::cosine, 3.0}, cosine3},
      {{Pattern::Kind::cosine, 0.5}, [](const Angles &a) { return std::sqrt(std::cos(a.theta_rad)); }},
      {table({0, 2.0}, {0}, flat), flat},
      {table(angles(degree, 91), angles(10 * degree, 36), ellipse), bilinear(degree, 10 * degree, ellipse)}};
  double x_m = -0.2;
  for (const auto &[pattern, gain] : kinds)
    mixed.lights.push_back(
        {light_at({{x_m += 0.1, 0, 0}, {x_m, 0.05, 0}}, 20 * x_m * degree, pattern), gain});
  check_wall(mixed);
}
