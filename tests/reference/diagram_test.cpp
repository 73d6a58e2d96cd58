// Diodes with measured diagrams: what a table says at its nodes, between them and beyond.

#include "engine/reference/light/radiation_laws.h"
#include "engine/reference/reference.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using std::numbers::pi;

double radians(double deg) { return deg * pi / 180; }

// Angles in degrees.
Diode diode_with(const std::vector<double> &theta_deg, const std::vector<double> &phi_deg,
                 const std::vector<double> &relative) {
  Diagram diagram{{}, {}, relative};
  for (const double deg : theta_deg)
    diagram.theta_rad.push_back(radians(deg));
  for (const double deg : phi_deg)
    diagram.phi_rad.push_back(radians(deg));
  Diode diode;
  diode.pattern.kind = Pattern::Kind::diagram;
  diode.pattern.diagram = std::make_shared<const Diagram>(diagram);
  return diode;
}

// From a diode along z whose phi begins at x, right-handed: towards y.
glm::dvec3 direction(double theta_deg, double phi_deg) {
  const double theta = radians(theta_deg), phi = radians(phi_deg);
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double gain(const Diode &diode, double theta_deg, double phi_deg = 0) {
  return reference::radiation(diode, -direction(theta_deg, phi_deg), 1);
}

} // namespace

TEST_CASE("a diagram has its values at its angles and is straight between them") {
  const Diode diode = diode_with({0, 20, 50}, {0}, {1.0, 0.8, 0.2});
  const double phi_deg = GENERATE(0.0, 77.0, 180.0, 301.0);
  CHECK(gain(diode, 0, phi_deg) == 1);
  CHECK(gain(diode, 20, phi_deg) == Approx(0.8).epsilon(1e-14));
  CHECK(gain(diode, 5, phi_deg) == Approx(0.95).epsilon(1e-14));
  CHECK(gain(diode, 30, phi_deg) == Approx(0.6).epsilon(1e-14));
  CHECK(gain(diode, 50, phi_deg) == Approx(0.2).epsilon(1e-14));
}

TEST_CASE("below its first angle and beyond its last a diagram is dark, both included") {
  const Diode diode = diode_with({10, 50}, {0}, {0.5, 0.2});
  for (const double phi_deg : {0.0, 13.0, 100.0, 222.0, 340.0}) {
    CHECK(gain(diode, 10, phi_deg) == Approx(0.5).epsilon(1e-12));
    CHECK(gain(diode, 50, phi_deg) == Approx(0.2).epsilon(1e-12));
    CHECK(gain(diode, 9.9999, phi_deg) == 0);
    CHECK(gain(diode, 50.0001, phi_deg) == 0);
    CHECK(gain(diode, 180, phi_deg) == 0);
  }
}

TEST_CASE("a diagram to 180 degrees ends behind the diode, whatever the rounding") {
  Diode diode = diode_with({0, 90, 180}, {0}, {1.0, 0.5, 0.25});
  Random random(31);
  for (int i = 0; i < 1000; ++i) {
    diode.axis = random.unit_vector();
    diode.across = glm::normalize(glm::cross(diode.axis, random.unit_vector()));
    const double range_m = random.uniform(0.01, 100);
    REQUIRE(reference::radiation(diode, range_m * diode.axis, range_m) == Approx(0.25).epsilon(1e-12));
  }
}

TEST_CASE("angles near the axis keep their digits") {
  const Diode diode = diode_with({0, 90}, {0}, {0.0, 1.0});
  for (const double deg : {1e-3, 1e-6, 1e-9})
    CHECK(gain(diode, deg, 40) == Approx(deg / 90).epsilon(1e-10));
}

TEST_CASE("a diagram with one angle is nowhere else") {
  const Diode diode = diode_with({0}, {0}, {1.0});
  CHECK(gain(diode, 0) == 1);
  CHECK(gain(diode, 0.001) == 0);
}

TEST_CASE("a diagram in two angles is linear in both") {
  const Diode diode = diode_with({0, 30, 60}, {0, 90, 180, 270},
                                 {1, 1, 1, 1,         //
                                  0.8, 0.6, 0.4, 0.2, //
                                  0.4, 0.3, 0.2, 0.1});
  CHECK(gain(diode, 30, 0) == Approx(0.8).epsilon(1e-13));
  CHECK(gain(diode, 30, 90) == Approx(0.6).epsilon(1e-13));
  CHECK(gain(diode, 60, 180) == Approx(0.2).epsilon(1e-13));
  CHECK(gain(diode, 60, 270) == Approx(0.1).epsilon(1e-13));
  CHECK(gain(diode, 30, 30) == Approx(0.8 - 0.2 / 3).epsilon(1e-13));
  CHECK(gain(diode, 45, 0) == Approx(0.6).epsilon(1e-13));
  // A quarter of the way in theta, a third in phi.
  CHECK(gain(diode, 37.5, 120) == Approx(0.75 * (0.6 - 0.2 / 3) + 0.25 * (0.3 - 0.1 / 3)).epsilon(1e-13));
}

TEST_CASE("phi goes on from the last to the first through 360 degrees") {
  const auto first_deg = GENERATE(0.0, 10.0, 100.0);
  const Diode diode =
      diode_with({10, 80}, {first_deg, first_deg + 120, first_deg + 240}, {0.2, 0.5, 0.8, 0.2, 0.5, 0.8});
  CHECK(gain(diode, 30, first_deg + 240) == Approx(0.8).epsilon(1e-13));
  CHECK(gain(diode, 30, first_deg + 300) == Approx(0.5).epsilon(1e-13));
  CHECK(gain(diode, 30, first_deg + 330) == Approx(0.35).epsilon(1e-13));
  CHECK(gain(diode, 30, first_deg + 360 - 1e-7) == Approx(0.2 + 0.6e-7 / 120).epsilon(1e-12));
  CHECK(gain(diode, 30, first_deg - 60) == Approx(0.5).epsilon(1e-13));
  CHECK(gain(diode, 30, first_deg) == Approx(0.2).epsilon(1e-13));
}

TEST_CASE("just before a full turn there is no step") {
  const Diode diode = diode_with({10, 80}, {0, 180}, {0.2, 0.8, 0.2, 0.8});
  for (const double y : {-1e-300, -1e-20, -1e-16, -0.0, 0.0, 1e-16, 1e-300})
    CHECK(reference::radiation(diode, {-1, -y, -1}, std::sqrt(2)) == Approx(0.2).epsilon(1e-13));
}

TEST_CASE("a diagram rolls about the axis with `across`") {
  Diode diode = diode_with({0, 80}, {0, 90, 180, 270}, {0.5, 0.5, 0.5, 0.5, 0.1, 0.2, 0.3, 0.4});
  diode.across = {0, 1, 0}; // phi 0 at y, 90 degrees at -x
  CHECK(gain(diode, 80, 90) == Approx(0.1).epsilon(1e-12));
  CHECK(gain(diode, 80, 180) == Approx(0.2).epsilon(1e-12));
  CHECK(gain(diode, 80, 270) == Approx(0.3).epsilon(1e-12));
  CHECK(gain(diode, 80, 0) == Approx(0.4).epsilon(1e-12));
}

TEST_CASE("the pose of the light turns a diagram's axis and roll") {
  // Seen from the wall's centre: 60 degrees off the axis, in the diagram's phi 90 degrees.
  Random random(32);
  const Pose world_from_illuminator{random.pose(1).rotation, glm::dvec3(0)};
  const Sensor sensor = axial_sensor();
  Illuminator light =
      diode_beside_lens(sensor, diode_with({0, 60, 90}, {0, 90, 180, 270},
                                           {1, 1, 1, 1, 0.1, 0.2, 0.3, 0.4, 0.1, 0.2, 0.3, 0.4}));
  light.world_from_illuminator = world_from_illuminator;
  const glm::dvec3 to_wall =
      glm::transpose(world_from_illuminator.rotation) * sensor.world_from_camera.direction({0, 0, 1});
  const glm::dvec3 beside = glm::normalize(glm::cross(to_wall, glm::dvec3(0.3, 0.8, -0.5)));
  Diode &diode = light.diodes[0];
  diode.axis = 0.5 * to_wall + std::sqrt(0.75) * beside;
  // The wall stands in the plane of the axis and axis x across.
  diode.across = glm::normalize(glm::cross(to_wall, diode.axis));
  const auto frame = reference::simulate(wall_at(1), sensor, {light}, Backscatter::constant);
  CHECK(frame.returns[0].amplitude[0] == Approx(0.2).epsilon(1e-5));
}

TEST_CASE("a finely tabulated cosine is the cosine") {
  std::vector<double> theta_deg, relative;
  for (int i = 0; i <= 900; ++i) {
    theta_deg.push_back(0.1 * i);
    relative.push_back(std::pow(std::cos(radians(0.1 * i)), 3));
  }
  const Diode diode = diode_with(theta_deg, {0}, relative);
  Random random(33);
  for (int i = 0; i < 1000; ++i) {
    const double deg = random.uniform(0, 90);
    CHECK(gain(diode, deg, random.uniform(0, 360)) ==
          Approx(std::pow(std::cos(radians(deg)), 3)).epsilon(0).margin(1.5e-6));
  }
}
