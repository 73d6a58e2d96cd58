// Exact frames of one sample a pixel against the reference, over what decides how their diodes are summed: by
// powers of q or by e, beforehand or in a loop, with weights that are all alike or not, in one run or
// several.

#include "tests/comparison/comparison.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Case {
  std::string name;
  double wall_m = 2.0;
  std::vector<Illuminator> lights;
  Backscatter backscatter = Backscatter::constant;
  Distortion distortion{}; // with one the points are kept
  double slope = 0.0;      // of the wall, along both axes
};

// Before the camera at z_m on its axis.
Scene slanted_wall(double z_m, double slope) {
  SceneBuilder scene;
  const auto corner = [&](double x_m, double y_m) {
    return glm::dvec3(x_m, y_m, z_m + slope * (x_m - 0.5 * y_m));
  };
  const double side_m = z_m;
  scene.add_mesh(
      {corner(-side_m, -side_m), corner(side_m, -side_m), corner(side_m, side_m), corner(-side_m, side_m)},
      {{0, 2, 1}, {0, 3, 2}});
  return scene.scene();
}

Illuminator ring_light(double radius_m, int count, const Pattern &pattern = {}, double z_m = 0.0) {
  std::vector<glm::dvec3> places_m = ring(count, radius_m);
  for (glm::dvec3 &place_m : places_m)
    place_m.z = z_m;
  return light_at(places_m, 0.0, pattern);
}

Illuminator unequal(Illuminator light) {
  for (std::size_t i = 0; i < light.diodes.size(); ++i)
    light.diodes[i].intensity_w_sr = 1.0 + 0.1 * static_cast<double>(i % 7);
  return light;
}

Illuminator raised(Illuminator light) {
  for (std::size_t i = 0; i < light.diodes.size(); ++i)
    light.diodes[i].position_m.z = 0.01 * static_cast<double>(i % 3);
  return light;
}

std::vector<Case> cases() {
  const Pattern cubed{Pattern::Kind::cosine, 3.0, {}}, broad{Pattern::Kind::cosine, 1.5, {}};
  const Backscatter lambert = Backscatter::lambert;
  return {
      {"alike, in a plane", 2.0, {ring_light(0.166, 48)}},
      {"alike, padded", 2.0, {ring_light(0.166, 37)}},
      {"alike, not in a plane", 2.0, {raised(ring_light(0.166, 48))}},
      {"alike, one long run", 2.0, {ring_light(0.166, 500)}},
      {"alike, two long runs, padded", 2.0, {ring_light(0.166, 1030)}},
      {"alike, two lights of long runs", 2.0, {ring_light(0.166, 300), ring_light(0.05, 500, {}, -3.0)}},
      {"alike, two long runs, points",
       2.0,
       {ring_light(0.166, 1030)},
       Backscatter::constant,
       BrownConrady{.k1 = -0.1}},
      {"unequal", 2.0, {unequal(ring_light(0.166, 48))}},
      {"Lambert", 2.0, {ring_light(0.166, 48)}, lambert},
      {"Lambert, cos^3, unequal", 2.0, {unequal(ring_light(0.166, 48, cubed))}, lambert},
      {"cos^1.5, by e", 2.0, {ring_light(0.166, 48, broad)}, lambert},
      {"alike, near, by e", 0.3, {ring_light(0.14, 48)}},
      {"Lambert, near, by e", 0.3, {ring_light(0.14, 48)}, lambert},
      {"a ring and a diode in the lens", 2.0, {ring_light(0.166, 48), ring_light(0.0, 1)}},
      {"two rings, one far off", 2.0, {ring_light(0.166, 48), ring_light(0.05, 20, {}, -3.0)}},
      {"alike, wall at a slant", 2.0, {ring_light(0.166, 240)}, Backscatter::constant, {}, 0.9},
      {"Lambert, wall at a slant", 2.0, {unequal(ring_light(0.166, 240))}, lambert, {}, 0.9},
      {"Lambert, cos^3, not in a plane, slant", 2.0, {raised(ring_light(0.1, 240))}, lambert, {}, 0.9},
      {"Lambert, cos^3, wall at a slant", 2.0, {unequal(ring_light(0.166, 240, cubed))}, lambert, {}, 0.9},
      {"the same with points", 2.0, {ring_light(0.166, 240, cubed)}, lambert, BrownConrady{.k1 = -0.1}, 0.9},
      {"the same nearby", 0.7, {ring_light(0.166, 240, cubed)}, lambert, {}, 0.5},
      {"farther away", 9.0, {unequal(ring_light(0.166, 48, cubed))}, lambert}};
}

// In the forms of all devices, with all shorter ways and without any.
std::vector<SimulatorOptions> all_forms() {
  std::vector<SimulatorOptions> forms = all_variants();
  for (SimulatorOptions options : all_variants()) {
    options.allowed.point_polynomials = options.allowed.direct_pixels = false;
    forms.push_back(options);
  }
  return forms;
}

} // namespace

TEST_CASE("frames of one sample a pixel, however their diodes are summed", "[long]") {
  fmt::print("{}", comparison_heading());
  for (const Case &of : cases()) {
    Sensor sensor;
    sensor.resolution = {40, 32};
    sensor.pixel_pitch_m = glm::dvec2(500e-6);
    sensor.focal_length_m = 0.02;
    sensor.distortion = of.distortion;
    const Scene scene = of.slope != 0.0 ? slanted_wall(of.wall_m, of.slope) : wall_at(of.wall_m);
    const auto expected = reference::simulate(scene, sensor, of.lights, of.backscatter);
    for (SimulatorOptions options : all_forms()) {
      options.keep_sample_ids = true;
      Simulator simulator = make_simulator(options);
      simulator.prepare(scene, sensor, of.lights, of.backscatter);
      const Comparison comparison = compare(simulator.measure(), expected, scene, sensor);
      INFO(of.name);
      fmt::print("{}", comparison_row(of.name, comparison));
      CHECK(comparison.pixels >= 1200); // but for the diagonal between the two triangles
      CHECK(comparison.distance_max_m <= 0.3e-6 + 6e-8 * of.wall_m);
      CHECK(comparison.amplitude_max_relative <= 2e-6);
    }
  }
}
