// Loops that shadows may need: a way that passes hundreds of thousands of triangles closely, and as many
// diodes. A device that stops a loop after 65,535 turns, as lavapipe does without a word, must not get it
// wrong.

#include "engine/reference/reference.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <optional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::size_t obstacles = 400'000;
// One diode's way leads along the obstacles, the other's is free.
const glm::dvec3 beset_m(0.3, 0.2, 0.0), free_m(-0.3, 0.1, 0.0);
const glm::dvec3 seen_m(0.0, 0.0, 2.0); // about where the pixels look

// Four pixels see points 1 mm apart on a wall at 2 m.
Sensor four_pixels() {
  Sensor sensor = axial_sensor({4, 1});
  sensor.pixel_pitch_m = glm::dvec2(5e-4);
  return sensor;
}

glm::dvec3 on_way(double share) { return beset_m + share * (seen_m - beset_m); }

using Mesh = std::pair<std::vector<glm::dvec3>, std::vector<std::array<std::uint32_t, 3>>>;

void add_triangle(Mesh &mesh, const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
  const auto first = static_cast<std::uint32_t>(mesh.first.size());
  mesh.first.insert(mesh.first.end(), {a, b, c});
  mesh.second.push_back({first, first + 1, first + 2});
}

// Triangles across the way, one behind the other. The ways pass each by 3 mm or less, inside of its box.
Mesh plates() {
  Mesh mesh;
  for (std::size_t k = 0; k < obstacles; ++k) {
    const double share = 0.05 + 0.85 * static_cast<double>(k) / obstacles, side = k % 2 == 0 ? 1.0 : -1.0;
    const glm::dvec3 centre_m = on_way(share) + side * glm::dvec3(1.5e-3, 1.5e-3, 0);
    add_triangle(mesh, centre_m + side * glm::dvec3(0.01, 0.01, 0),
                 centre_m + side * glm::dvec3(-0.01, 0.01, 0), centre_m + side * glm::dvec3(0.01, -0.01, 0));
  }
  return mesh;
}

// Slivers along the way, 4 to 10 mm beside it.
Mesh needles() {
  Mesh mesh;
  Random random(65'536);
  for (std::size_t k = 0; k < obstacles; ++k) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), off_m = random.uniform(4e-3, 10e-3);
    const glm::dvec3 aside_m = off_m * glm::dvec3(std::cos(angle), std::sin(angle), 0);
    add_triangle(mesh, on_way(0.05) + aside_m, on_way(0.9) + aside_m, on_way(0.9) + 1.0001 * aside_m);
  }
  return mesh;
}

// The obstacles and the wall; perhaps a triangle across the ways, at this share of them.
Scene beset_wall(const Mesh &obstacles_mesh, std::optional<double> blocker) {
  SceneBuilder builder;
  builder.add_wall({seen_m.z});
  builder.add_mesh(obstacles_mesh.first, obstacles_mesh.second, {0.5, true});
  if (blocker) {
    const glm::dvec3 at_m = on_way(*blocker);
    builder.add_triangle(at_m + glm::dvec3(0, 0.008, 0), at_m + glm::dvec3(0.008, -0.008, 0),
                         at_m + glm::dvec3(-0.008, -0.008, 0), {0.5, true});
  }
  return builder.scene();
}

void check_lit(const std::string &name, const Scene &scene, float expected) {
  const Sensor sensor = four_pixels();
  Illuminator two = diode_beside_lens(sensor, diode_at(beset_m));
  two.diodes.push_back(diode_at(free_m));
  Simulator simulator = make_simulator();
  simulator.prepare(scene, sensor, {two}, Backscatter::lambert, Shadows::automatic);
  const Measurement measured = simulator.measure();
  const auto frame = reference::simulate(scene, sensor, {two}, Backscatter::lambert, {Shadows::automatic});
  REQUIRE(measured.lit.size() == 4);
  fmt::print("{:<60} lit {:.2f}, frame {:.0f} ms\n", name, measured.lit[0], measured.frame_ms);
  INFO(name);
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    CHECK(measured.triangle_id[pixel] < 2); // the wall
    CHECK(frame.lit[pixel] == expected);
    CHECK(measured.lit[pixel] == expected);
    CHECK(std::abs(measured.returns[0].distance_m[pixel] - frame.returns[0].distance_m[pixel]) <= 2e-6);
  }
}

void check_obstacles(const std::string &name, const Mesh &mesh) {
  check_lit(fmt::format("{} {}, nothing blocks", obstacles, name), beset_wall(mesh, std::nullopt), 1.0f);
  check_lit(fmt::format("{} {}, one blocks near the diode", obstacles, name), beset_wall(mesh, 0.02), 0.5f);
  check_lit(fmt::format("{} {}, one blocks near the wall", obstacles, name), beset_wall(mesh, 0.95), 0.5f);
}

// A spiral disc of diodes beside the lens.
Illuminator diodes_beside_lens(std::size_t count, const Sensor &sensor) {
  Illuminator illuminator{"many", sensor.world_from_camera, {}};
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t k = 0; k < count; ++k) {
    const double radius_m = 0.166 * std::sqrt((static_cast<double>(k) + 0.5) / static_cast<double>(count));
    const double angle = golden_angle * static_cast<double>(k);
    illuminator.diodes.push_back(
        diode_at({0.4 + radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0}));
  }
  return illuminator;
}

void check_shadow_counts(const std::vector<std::size_t> &counts) {
  Sensor sensor;
  sensor.resolution = {10, 7}; // no ray along the wall's diagonal
  sensor.pixel_pitch_m = glm::dvec2(3e-3);
  sensor.focal_length_m = 0.05;
  SceneBuilder builder;
  builder.add_wall({2.0});
  builder.add_wall({1.0, {0.5, true}, {0.22, -5.0}, {5.0, 5.0}});
  builder.add_wall({1.2, {0.5, true}, {-0.07, -0.1}, {-0.05, 0.1}});
  for (const std::size_t count : counts) {
    const Illuminator illuminator = diodes_beside_lens(count, sensor);
    Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true, .keep_visibility = true});
    simulator.prepare(builder.scene(), sensor, {illuminator}, Backscatter::lambert, Shadows::automatic);
    const Measurement measured = simulator.measure();
    const auto expected = reference::simulate(builder.scene(), sensor, {illuminator}, Backscatter::lambert,
                                              {Shadows::automatic, true});
    std::size_t differing = 0;
    REQUIRE(measured.sample_visibility.size() == expected.sample_visibility.size());
    for (std::size_t word = 0; word < expected.sample_visibility.size(); ++word)
      differing += measured.sample_visibility[word] != expected.sample_visibility[word];
    fmt::print("{} diodes: {} of {} words of 32 diodes differ\n", count, differing,
               expected.sample_visibility.size());
    CHECK(static_cast<double>(differing) <= 1e-4 * static_cast<double>(expected.sample_visibility.size()));
    REQUIRE(measured.sample_triangle_id == expected.sample_triangle_id);
  }
}

} // namespace

// These two may fail: where a device ends loops early, a frame with so many edges in the light of a sample is
// refused, until the sweep has a path without such loops.
TEST_CASE("a way past 400,000 triangles", "[long]") {
  check_obstacles("plates", plates());
  check_obstacles("needles", needles());
}

// Ways that lead past the obstacles each in its own manner: rays that share a vector hold each other up, and
// what all of them need together counts.
TEST_CASE("64 ways past 20,000 slanting slivers and 300 plates") {
  Sensor sensor;
  sensor.resolution = {8, 8};
  sensor.pixel_pitch_m = glm::dvec2(3.1e-3);
  sensor.focal_length_m = 0.02;
  Random random(7);
  Mesh mesh;
  for (int k = 0; k < 20'000; ++k) {
    const glm::dvec3 middle_m = random.in_box({-0.6, -0.6, 0.9}, {0.6, 0.6, 1.1});
    const glm::dvec3 half_m(random.uniform(0.75, 1.1) * (random.flip() ? 1.0 : -1.0),
                            random.uniform(0.75, 1.1), 0.3);
    add_triangle(mesh, middle_m - half_m, middle_m + half_m, middle_m + half_m + glm::dvec3(1e-7, 0, 0));
  }
  for (int k = 0; k < 300; ++k) {
    const glm::dvec3 middle_m = random.in_box({-0.6, -0.6, 0.8}, {0.6, 0.6, 1.2});
    add_triangle(mesh, middle_m + glm::dvec3(0, 0.04, 0), middle_m + glm::dvec3(0.04, -0.04, 0),
                 middle_m + glm::dvec3(-0.04, -0.04, 0));
  }
  const Scene scene = beset_wall(mesh, std::nullopt);
  Illuminator eight = diode_beside_lens(sensor, diode_at(beset_m));
  for (int k = 1; k < 8; ++k)
    eight.diodes.push_back(diode_at(beset_m + static_cast<double>(k) * glm::dvec3(0.02, -0.015, 0)));
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true, .keep_visibility = true});
  simulator.prepare(scene, sensor, {eight}, Backscatter::lambert, Shadows::automatic);
  const Measurement measured = simulator.measure();
  const auto expected =
      reference::simulate(scene, sensor, {eight}, Backscatter::lambert, {Shadows::automatic, true});
  std::size_t on_the_wall = 0, blocked = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    if (measured.sample_triangle_id[i] != expected.sample_triangle_id[i] ||
        measured.sample_triangle_id[i] > 1)
      continue; // a sliver or a plate is seen
    ++on_the_wall;
    blocked += 8 - static_cast<std::size_t>(std::popcount(expected.sample_visibility[i]));
    CHECK(measured.sample_visibility[i] == expected.sample_visibility[i]);
  }
  fmt::print("64 ways past slivers: {} pixels of the wall, {} pairs blocked, frame {:.0f} ms\n", on_the_wall,
             blocked, measured.frame_ms);
  CHECK(on_the_wall > 30);
  CHECK(blocked > 50);
}

TEST_CASE("shadows of 1 to 240 diodes") { check_shadow_counts({1, 33, 240}); }

TEST_CASE("shadows of 1 to 100,000 diodes", "[long]") {
  check_shadow_counts({1, 31, 32, 33, 240, 4000, 65'537, 100'000});
}
