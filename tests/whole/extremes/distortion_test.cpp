// Cases that a lens with distortion makes hard: triangles smaller than pixels, and images one pixel wide.

#include "engine/lens/lens.h"
#include "tests/comparison/comparison.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

double bumpy_radius_m(const glm::dvec3 &direction, double radius_m) {
  return radius_m * (1 + 0.02 * std::sin(13 * direction.x) * std::sin(17 * direction.y + 5 * direction.z));
}

// A cube blown up to a sphere with bumps: 12 n^2 triangles in six meshes that only share places. A negative
// radius turns the inside out.
void add_bumpy_sphere(SceneBuilder &builder, const glm::dvec3 &centre_m, double radius_m, std::uint32_t n) {
  for (int face = 0; face < 6; ++face) {
    std::vector<glm::dvec3> corners_m;
    std::vector<std::array<std::uint32_t, 3>> faces;
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1.0 : -1.0;
    for (std::uint32_t i = 0; i <= n; ++i)
      for (std::uint32_t j = 0; j <= n; ++j) {
        glm::dvec3 on_cube;
        on_cube[axis] = side;
        on_cube[(axis + 1) % 3] = side * (2.0 * i - n) / n;
        on_cube[(axis + 2) % 3] = (2.0 * j - n) / n;
        const glm::dvec3 direction = on_cube / std::sqrt(glm::dot(on_cube, on_cube));
        corners_m.push_back(centre_m + bumpy_radius_m(direction, radius_m) * direction);
        if (i < n && j < n) {
          const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
          faces.insert(faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
        }
      }
    builder.add_mesh(corners_m, faces, {0.3 + 0.1 * face, false});
  }
}

// Behind a lens that shows its corners `corner` off the axis: a slope, or a fisheye's angle.
Sensor sensor_to(double corner, const Distortion &distortion, const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.pixel_pitch_m = glm::dvec2(20e-6);
  sensor.focal_length_m = 0.5 * glm::length(glm::dvec2(resolution)) * 20e-6 / corner;
  sensor.distortion = distortion;
  return sensor;
}

Illuminator few_diodes(const Sensor &sensor) {
  Illuminator illuminator{"few", sensor.world_from_camera, {}};
  for (const glm::dvec2 at : {glm::dvec2(0.1, 0.02), glm::dvec2(-0.12, 0.05), glm::dvec2(0.01, -0.15)})
    illuminator.diodes.push_back(diode_at({at, 0.0}));
  return illuminator;
}

void check_against_reference(const std::string &name, const Scene &scene, const Sensor &sensor) {
  INFO(name);
  REQUIRE_FALSE(lens_fault(sensor));
  const Illuminator illuminator = few_diodes(sensor);
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true});
  simulator.prepare(scene, sensor, {illuminator}, Backscatter::constant);
  const Comparison comparison =
      compare(simulator.measure(), reference::simulate(scene, sensor, {illuminator}, Backscatter::constant),
              scene, sensor);
  fmt::print("{}", comparison_row(name, comparison));
  check_comparison(comparison, sensor.pixel_count() / 2);
}

} // namespace

TEST_CASE("a mesh finer than the pixels, through a barrel") {
  SceneBuilder builder;
  add_bumpy_sphere(builder, {0, 0, 2}, 0.5, 130);
  builder.add_wall({4.0});
  REQUIRE(builder.scene().triangles.size() > 200'000);
  Sensor sensor = sensor_to(0.5, BrownConrady{-0.3, 0.05, 0.01, -0.01, 0}, {320, 240});
  fmt::print("{}", comparison_heading());
  for (const std::uint32_t samples : {1u, 2u}) {
    sensor.samples = samples;
    check_against_reference(fmt::format("200,000 triangles, S = {}", samples), builder.scene(), sensor);
  }
}

TEST_CASE("images one pixel wide") {
  SceneBuilder builder;
  add_bumpy_sphere(builder, {0.1, 0.037, 2}, 0.5, 20);
  add_bumpy_sphere(builder, {0.13, -0.21, 0}, -5.0, 10); // seen from inside; no edge runs along the image
  fmt::print("{}", comparison_heading());
  for (const glm::uvec2 resolution : {glm::uvec2(1, 500), glm::uvec2(500, 1)})
    for (const std::uint32_t samples : {1u, 3u}) {
      const std::vector<std::pair<std::string, Sensor>> sensors{
          {"barrel", sensor_to(0.6, BrownConrady{-0.3, 0, 0, 0, 0}, resolution)},
          {"pincushion", sensor_to(1.0, BrownConrady{0.4, 0, 0.01, -0.02, 0}, resolution)},
          {"fisheye", sensor_to(55 * degree, Fisheye{-0.03, 0.01, -0.004, 0.0005}, resolution)}};
      for (auto [name, sensor] : sensors) {
        sensor.samples = samples;
        check_against_reference(fmt::format("{} x {}, {}, S = {}", resolution.x, resolution.y, name, samples),
                                builder.scene(), sensor);
      }
    }
}
