// Shapes with holes in the light, beside a mesh without them, against the reference: pair by pair.

#include "tests/comparison/visibility_comparison.h"
#include "tests/shadow/boards.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// All around the lens, some of them behind what is seen.
Places cloud(Random &random, std::size_t count) {
  Places places_m;
  for (std::size_t i = 0; i < count; ++i)
    places_m.push_back(random.in_box({-1.0, -1.0, -0.5}, {1.0, 1.0, 2.0}));
  return places_m;
}

// A leaf's outline in the square of its texture.
std::shared_ptr<const Texture> outline() {
  Texture texture{{16, 16}, {}};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      texture.texels.emplace_back(1.0f, 1.0f, 1.0f, std::hypot(x - 7.5, 2.0 * (y - 7.5)) < 7.0 ? 1.0f : 0.0f);
  return std::make_shared<const Texture>(std::move(texture));
}

Surface masked(const std::shared_ptr<const Texture> &texture) {
  Surface surface{0.0, true, Paint{glm::dvec3(0.5)}};
  surface.paint->texture = texture;
  surface.paint->alpha_cutoff = 0.5;
  return surface;
}

// A mesh whose corners have places in a texture.
struct Sheet {
  std::vector<glm::dvec3> corners_m;
  std::vector<glm::dvec2> coordinates;
  std::vector<std::array<std::uint32_t, 3>> faces;

  void add_square(const glm::dvec3 &centre_m, const glm::dvec3 &u_m, const glm::dvec3 &v_m) {
    const auto first = static_cast<std::uint32_t>(corners_m.size());
    corners_m.insert(corners_m.end(), {centre_m - u_m - v_m, centre_m + u_m - v_m, centre_m + u_m + v_m,
                                       centre_m - u_m + v_m});
    coordinates.insert(coordinates.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    faces.insert(faces.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
};

class LeafScene {
public:
  explicit LeafScene(const Pose &world_from_camera) : builder_(world_from_camera) {}

  void add_wall(double z_m) {
    builder_.add_wall({z_m});
    coordinates_.resize(builder_.scene().positions_m.size());
  }
  void add(const Sheet &sheet, const Surface &surface) {
    builder_.add_mesh(sheet.corners_m, sheet.faces, surface);
    coordinates_.insert(coordinates_.end(), sheet.coordinates.begin(), sheet.coordinates.end());
  }
  Scene scene() const {
    Scene made = builder_.scene();
    made.texture_coordinates.assign(coordinates_.begin(), coordinates_.end());
    return made;
  }

private:
  SceneBuilder builder_;
  std::vector<glm::dvec2> coordinates_;
};

Sheet leaves(Random &random, std::size_t count, double size_m) {
  Sheet sheet;
  for (std::size_t i = 0; i < count; ++i) {
    const double z_m = random.uniform(0.8, 2.5);
    const glm::dvec3 centre_m(z_m * random.uniform(-0.6, 0.6), z_m * random.uniform(-0.6, 0.6), z_m);
    const glm::dvec3 u = random.unit_vector(), across = glm::normalize(glm::cross(u, random.unit_vector()));
    const double of_leaf_m = size_m * random.uniform(0.5, 1.5);
    sheet.add_square(centre_m, of_leaf_m * u, of_leaf_m * across);
  }
  return sheet;
}

// A bumpy sheet of columns x columns squares, cut from one grid of corners, of which some have holes: solid
// and cut ones share edges and corners.
std::array<Sheet, 2> patchwork(Random &random, std::uint32_t columns) {
  std::vector<glm::dvec3> corners_m;
  std::vector<glm::dvec2> coordinates;
  for (std::uint32_t y = 0; y <= columns; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x) {
      corners_m.emplace_back(2.0 * x / columns - 1.0, 2.0 * y / columns - 1.0, random.uniform(1.3, 1.5));
      coordinates.emplace_back(x % 2, y % 2);
    }
  std::array<Sheet, 2> sheets{Sheet{corners_m, coordinates, {}}, Sheet{corners_m, coordinates, {}}};
  for (std::uint32_t y = 0; y < columns; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
      for (const std::array<std::uint32_t, 3> &face : {std::array{a, b, b + 1}, std::array{a, b + 1, a + 1}})
        if (const double kind = random.uniform(0, 1); kind < 0.8) // a fifth is left out
          sheets[kind < 0.4 ? 0 : 1].faces.push_back(face);
    }
  return sheets;
}

void scatter(Random &random, std::size_t count, const Pose &world_from_camera, Scene &scene) {
  const auto surface = static_cast<std::uint32_t>(scene.surfaces.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.surfaces.push_back({0.5, false});
  scene.objects.emplace_back("points");
  for (std::size_t i = 0; i < count; ++i) {
    scene.discs.push_back(
        {static_cast<std::uint32_t>(scene.positions_m.size()), random.uniform(0.005, 0.06), surface, object});
    scene.positions_m.push_back(world_from_camera.point(random.in_box({-0.7, -0.7, 0.8}, {0.7, 0.7, 1.9})));
    if (!scene.texture_coordinates.empty())
      scene.texture_coordinates.emplace_back(0.0);
  }
}

std::string visibility_of(const Simulator &simulator) {
  for (const auto &[name, value] : simulator.path())
    if (name == "visibility")
      return value;
  return {};
}

void check_scene(const std::string &name, const Scene &scene, const Sensor &sensor,
                 const std::vector<Places> &boards, const SimulatorOptions &more = {}) {
  INFO(name);
  SimulatorOptions options = more;
  options.keep_sample_ids = options.keep_visibility = true;
  const auto illuminators = illuminators_of(boards, sensor);
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, illuminators, Backscatter::lambert, Shadows::automatic);
  CHECK(visibility_of(simulator).ends_with(", holes"));
  const Measurement measured = simulator.measure();
  const reference::Frame expected =
      reference::simulate(scene, sensor, illuminators, Backscatter::lambert, {Shadows::automatic, true});
  const ReachedComparison reached = compare_reached(measured, expected, scene, sensor, illuminators);
  fmt::print("{}", reached_row(name, reached));
  CHECK(reached.clear_of_all == 0);
  CHECK(reached.differing_fraction() <= 1e-4);
  CHECK(reached.lit_error <= 1e-6);
  CHECK(reached.reached > 0);
  CHECK(reached.reached < reached.pairs);
  CHECK(share_of_pixels_agreeing(measured, expected) >= 0.98);
}

Scene leaves_before_wall(std::uint32_t seed, std::size_t count, double size_m,
                         const Pose &world_from_camera) {
  Random random(seed);
  LeafScene scene(world_from_camera);
  scene.add_wall(3.0);
  scene.add(leaves(random, count, size_m), masked(outline()));
  return scene.scene();
}

} // namespace

TEST_CASE("triangles with holes and without share edges", "[smoke]") {
  fmt::print("{}", reached_heading());
  for (std::uint32_t seed = 60; seed < 63; ++seed) {
    const Sensor sensor = tumbled_camera(seed, 32);
    Random random(seed);
    LeafScene scene(sensor.world_from_camera);
    scene.add_wall(2.0);
    const auto [solid, cut] = patchwork(random, 10);
    scene.add(solid, {0.5, true});
    scene.add(cut, masked(outline()));
    check_scene(fmt::format("patchwork {}", seed), scene.scene(), sensor, {rings_about({0.3, 0.1, 0}, 48)});
  }
}

TEST_CASE("a leaf before a wall, lit from beside the camera") {
  const Sensor sensor = tumbled_camera(64, 48);
  LeafScene scene(sensor.world_from_camera);
  scene.add_wall(2.0);
  Sheet leaf;
  leaf.add_square({0.0, 0.0, 1.0}, {0.3, 0.02, 0.05}, {-0.01, 0.25, 0.1});
  scene.add(leaf, masked(outline()));
  fmt::print("{}", reached_heading());
  check_scene("a leaf", scene.scene(), sensor, {rings_about({0.8, 0.2, 0.1}, 48)});
  check_scene("a leaf, a diode", scene.scene(), sensor, {{{0.8, 0.2, 0.1}}});
  check_scene("a leaf, short strips", scene.scene(), sensor, {rings_about({0.8, 0.2, 0.1}, 48)},
              {.device = {}, .max_strip_samples = 500});
}

TEST_CASE("discs keep light off beside a mesh without holes") {
  const Sensor sensor = tumbled_camera(65, 40);
  Random random(65);
  Scene scene = random_triangles(random, 100, sensor.world_from_camera);
  scatter(random, 60, sensor.world_from_camera, scene);
  fmt::print("{}", reached_heading());
  check_scene("discs and triangles", scene, sensor, {rings_about({0.2, 0, 0}, 48)});
}

TEST_CASE("any board shines through leaves") {
  const Sensor sensor = tumbled_camera(66, 24);
  const Scene scene = leaves_before_wall(66, 150, 0.06, sensor.world_from_camera);
  Random random(67);
  fmt::print("{}", reached_heading());
  check_scene("around the lens", scene, sensor, {rings_about({0, 0, 0}, 48)});
  check_scene("between the leaves", scene, sensor, {rings_about({0, 0, 1.5}, 48)});
  check_scene("behind the wall", scene, sensor, {rings_about({0, 0, 0.2}, 48), rings_about({0, 0, 3.5}, 3)});
  check_scene("two boards", scene, sensor, {rings_about({-0.4, 0, 0}, 300), rings_about({0.4, 0, 0.1}, 300)});
  check_scene("more diodes than a window has", scene, sensor, {rings_about({0.1, 0, 0}, 600)});
  check_scene("diodes all around", scene, sensor, {cloud(random, 70)});
}

TEST_CASE("several samples a pixel, lenses with distortion and float pairs see leaves", "[long]") {
  Sensor sensor = tumbled_camera(68, 20);
  const Scene scene = leaves_before_wall(68, 150, 0.06, sensor.world_from_camera);
  const std::vector<Places> boards{rings_about({0.2, 0, 0}, 48)};
  fmt::print("{}", reached_heading());
  check_scene("float pairs", scene, sensor, boards,
              {.device = {}, .precision = SamplePrecision::double_float});
  sensor.samples = 2;
  check_scene("four samples", scene, sensor, boards);
  sensor.fill_factor = {0.7, 0.6};
  check_scene("pixels filled in part", scene, sensor, boards);
  sensor.distortion = BrownConrady{-0.2, 0.05, 1e-3, -1e-3};
  check_scene("distortion", scene, sensor, boards);
}

TEST_CASE("light through 20,000 triangles with holes") {
  const Sensor sensor = tumbled_camera(69, 48);
  fmt::print("{}", reached_heading());
  check_scene("20,000 of leaves", leaves_before_wall(69, 10'000, 0.02, sensor.world_from_camera), sensor,
              {rings_about({0.1, 0, 0}, 240)});
}

// All leaves lie in the ways of all samples: loops as long as they get.
TEST_CASE("400 leaves behind each other, each with a hole for all of the light") {
  const Sensor sensor = tumbled_camera(70, 6);
  Texture texture{{4, 4}, std::vector<glm::vec4>(16, glm::vec4(1.0f, 1.0f, 1.0f, 0.0f))};
  texture.texels[0].a = 1.0f;
  LeafScene scene(sensor.world_from_camera);
  scene.add_wall(2.0);
  Sheet stack;
  for (int i = 0; i < 400; ++i)
    stack.add_square({0.0, 0.0, 1.0 + 1e-4 * i}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  Sheet last;
  last.add_square({0.1, 0.0, 1.2}, {0.2, 0.0, 0.0}, {0.0, 0.2, 0.0});
  scene.add(stack, masked(std::make_shared<const Texture>(std::move(texture))));
  scene.add(last, masked(outline()));
  fmt::print("{}", reached_heading());
  check_scene("400 behind each other", scene.scene(), sensor, {rings_about({0.1, 0, 0}, 240)});
}
