// Shapes that are left out of the occluders never block anything; a scene that needs no shadows has no
// occluders.

#include "engine/shadow/occluders.h"

#include "engine/view/mesh_edges.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const std::vector<std::array<std::uint32_t, 3>> box_faces{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                          {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                          {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

std::vector<glm::dvec3> box_corners(const glm::dvec3 &low_m, const glm::dvec3 &high_m) {
  std::vector<glm::dvec3> corners_m;
  for (unsigned k = 0; k < 8; ++k)
    corners_m.push_back(glm::mix(low_m, high_m, glm::bvec3(k & 1, k & 2, k & 4)));
  return corners_m;
}

// Its front to the outside, or to the inside.
void add_box(SceneBuilder &builder, const glm::dvec3 &low_m, const glm::dvec3 &high_m,
             bool inside_out = false) {
  auto faces = box_faces;
  if (inside_out)
    for (auto &face : faces)
      std::swap(face[1], face[2]);
  builder.add_mesh(box_corners(low_m, high_m), faces);
}

std::vector<CameraIlluminator> ring_light(double radius_m = 0.166, double z_m = 0.0) {
  CameraIlluminator light;
  for (int k = 0; k < 48; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / 48;
    light.diodes.push_back(diode_at({radius_m * std::cos(angle), radius_m * std::sin(angle), z_m}));
  }
  return {light};
}

std::set<std::uint32_t> occluder_ids(const Scene &scene, const std::vector<CameraIlluminator> &lights,
                                     const Sensor &sensor = {}) {
  std::set<std::uint32_t> ids;
  for (const shader::Occluder &occluder : find_occluders(to_camera(scene, sensor), scene, lights).shapes)
    REQUIRE(ids.insert(occluder.id).second);
  return ids;
}

glm::dvec3 whole(const glm::vec4 &hi, const glm::vec4 &lo) { return glm::dvec3(hi) + glm::dvec3(lo); }

std::array<glm::dvec3, 3> corners_of(const shader::Occluder &occluder) {
  return {whole(occluder.a_hi, occluder.a_lo), whole(occluder.b_hi, occluder.b_lo),
          whole(occluder.c_hi, occluder.c_lo)};
}

// Whether a triangle stands between two points.
bool is_between(const std::array<glm::dvec3, 3> &abc, const glm::dvec3 &from, const glm::dvec3 &to) {
  const auto volume = [](const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
    return glm::dot(a, glm::cross(b, c));
  };
  const glm::dvec3 a = abc[0] - from, b = abc[1] - from, c = abc[2] - from, way = to - from;
  const double ab = volume(way, a, b), bc = volume(way, b, c), ca = volume(way, c, a);
  if (!((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0)))
    return false;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double along = glm::dot(normal, a) / glm::dot(normal, way);
  return along > 0.0 && along < 1.0;
}

// Loose triangles around the lens, and closed boxes.
Scene random_mixture(Random &random, const Pose &world_from_camera) {
  SceneBuilder builder(world_from_camera);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 at = random.in_box({-1, -1, -0.5}, {1, 1, 2});
    const double size_m = random.uniform(0.05, 0.6);
    builder.add_triangle(at, at + size_m * random.unit_vector(), at + size_m * random.unit_vector(),
                         {1.0, random.flip()});
  }
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 low = random.in_box({-1, -1, 0.2}, {1, 1, 2});
    add_box(builder, low, low + random.in_box(glm::dvec3(0.05), glm::dvec3(0.5)), random.flip());
  }
  builder.add_wall({2.5});
  return builder.scene();
}

glm::dvec3 point_of(const CameraTriangle &triangle, Random &random) {
  const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
  const auto &[a, b, c] = triangle.corners_m;
  return a + u * (b - a) + v * (c - a);
}

} // namespace

TEST_CASE("a single wall stands in nobody's light") {
  CHECK(occluder_ids(wall_at(2.0), ring_light()).empty());
  CHECK(occluder_ids(wall_at(2.0, {1.0, true}), ring_light()).empty());
}

TEST_CASE("the walls of a closed box stand in nobody's light inside it") {
  SceneBuilder builder;
  add_box(builder, {-2, -1.5, -1}, {2, 1.5, 3}, true);
  CHECK(occluder_ids(builder.scene(), ring_light()).empty());
}

TEST_CASE("a tilted wall of two triangles far from the world's origin does not block its own light") {
  Random random(41);
  for (int i = 0; i < 200; ++i) {
    Sensor sensor;
    sensor.world_from_camera = random.pose(1e5);
    SceneBuilder builder(sensor.world_from_camera);
    const glm::dvec3 middle(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(1, 3));
    const glm::dvec3 u(1.0, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)),
        v(random.uniform(-0.3, 0.3), 1.0, random.uniform(-0.3, 0.3));
    builder.add_mesh({middle - u - v, middle - u + v, middle + u + v, middle + u - v},
                     {{0, 1, 2}, {0, 2, 3}});
    REQUIRE(to_camera(builder.scene(), sensor).triangles.size() == 2);
    CHECK(occluder_ids(builder.scene(), ring_light(), sensor).empty());
  }
}

TEST_CASE("of a box before a wall the box may block, the wall may not") {
  SceneBuilder builder;
  builder.add_wall({2.0});
  add_box(builder, {-0.2, -0.2, 1.0}, {0.2, 0.2, 1.2});
  const auto ids = occluder_ids(builder.scene(), ring_light());
  CHECK_FALSE(ids.empty());
  CHECK_FALSE(ids.contains(0));
  CHECK_FALSE(ids.contains(1));
}

TEST_CASE("a plate blocks where diodes and what is seen lie on both sides of it") {
  const glm::dvec3 a(0.3, -1, 0.5), b(0.3, 1, 0.5), c(0.3, 0, 1.5);
  const auto blocks = [&](double wall_to_x_m, double diodes_at_x_m) {
    SceneBuilder builder;
    builder.add_wall({2.0, {}, {-1, -1}, {wall_to_x_m, 1}});
    const std::uint32_t id = builder.add_triangle(a, b, c, {1.0, true});
    return occluder_ids(builder.scene(), {{{diode_at({diodes_at_x_m, 0, 0}), diode_at({-0.1, 0, 0})}}})
        .contains(id);
  };
  CHECK_FALSE(blocks(0.25, 0.1)); // all on the side of the lens
  CHECK_FALSE(blocks(0.25, 0.3)); // a diode in its plane
  CHECK(blocks(0.5, 0.1));        // the wall goes on behind it
  CHECK(blocks(0.25, 0.5));       // a diode stands behind it
}

TEST_CASE("back faces that the lens does not see block") {
  SceneBuilder builder;
  builder.add_wall({2.0});
  const std::uint32_t culled = builder.add_triangle({-0.1, -0.1, 1}, {0.1, -0.1, 1}, {0, 0.1, 1});
  const std::uint32_t edge_on = builder.add_triangle({0, -0.1, 1}, {0, 0.1, 1}, {0, 0, 1.2});
  REQUIRE(to_camera(builder.scene(), Sensor()).hidden.size() == 2);
  CHECK(occluder_ids(builder.scene(), ring_light()) == std::set{culled, edge_on});
}

TEST_CASE("discs and shapes with holes are known as such") {
  SceneBuilder builder;
  builder.add_wall({2.0});
  Surface cutouts;
  cutouts.paint = Paint{};
  cutouts.paint->alpha_cutoff = 0.5;
  builder.add_triangle({-0.1, -0.1, 1}, {0, 0.1, 1}, {0.1, -0.1, 1}, cutouts);
  builder.add_triangle({-0.1, -0.1, 1.5}, {0, 0.1, 1.5}, {0.1, -0.1, 1.5});
  Scene scene = builder.scene();
  scene.discs.push_back({static_cast<std::uint32_t>(scene.positions_m.size()), 0.05, 0, 0});
  scene.positions_m.push_back(node_from_camera().point({0, 0, 1.2}));
  const Occluders occluders = find_occluders(to_camera(scene, Sensor()), scene, ring_light());
  REQUIRE(occluders.shapes.size() == 1);
  CHECK(occluders.shapes[0].id == 3);
  REQUIRE(occluders.with_holes.size() == 2);
  CHECK(occluders.with_holes[0].id == 2);
  CHECK(occluders.with_holes[1].id == 4);
}

TEST_CASE("an occluder is its triangle, to 48 bits, and its plane holds it") {
  Random random(42);
  Sensor sensor;
  sensor.world_from_camera = random.pose(3.0);
  const Scene scene = random_mixture(random, sensor.world_from_camera);
  const CameraScene camera = to_camera(scene, sensor);
  std::vector<std::array<glm::dvec3, 3>> corners_m(scene.shape_count());
  for (const auto *triangles : {&camera.triangles, &camera.hidden})
    for (const CameraTriangle &triangle : *triangles)
      corners_m[triangle.id] = triangle.corners_m;
  for (const shader::Occluder &occluder : find_occluders(camera, scene, ring_light()).shapes) {
    const auto found_m = corners_of(occluder);
    const glm::dvec3 normal = whole(occluder.plane_hi, occluder.plane_lo);
    const double offset_m = double(occluder.plane_hi.w) + double(occluder.plane_lo.w);
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE(glm::distance(found_m[k], corners_m[occluder.id][k]) < 1e-13);
      REQUIRE(std::abs(glm::dot(normal, found_m[k]) - offset_m) < 1e-12);
    }
    REQUIRE(glm::dot(normal, glm::cross(found_m[1] - found_m[0], found_m[2] - found_m[0])) > 0.0);
  }
}

TEST_CASE("triangles that share an edge take it in the same direction") {
  Random random(43);
  for (int i = 0; i < 50; ++i) {
    Sensor sensor;
    sensor.world_from_camera = random.pose(10.0);
    SceneBuilder builder(sensor.world_from_camera);
    builder.add_wall({3.0});
    const glm::dvec3 at = random.in_box({-0.3, -0.3, 1}, {0.3, 0.3, 2});
    std::vector<glm::dvec3> corners_m(box_corners(at, at + glm::dvec3(0.2)));
    for (glm::dvec3 &corner_m : corners_m)
      corner_m += 0.05 * random.unit_vector();
    builder.add_mesh(corners_m, box_faces);
    const Scene &scene = builder.scene();
    std::set<std::array<float, 12>> edges; // from and to, with their rests
    std::size_t sides = 0;
    for (const shader::Occluder &o : find_occluders(to_camera(scene, sensor), scene, ring_light()).shapes) {
      const std::array hi{o.a_hi, o.b_hi, o.c_hi}, lo{o.a_lo, o.b_lo, o.c_lo};
      for (std::size_t k = 0; k < 3; ++k, ++sides) {
        const bool turned = (o.edges >> k & 1u) != 0;
        const std::size_t from = turned ? (k + 1) % 3 : k, to = turned ? k : (k + 1) % 3;
        CHECK(comes_before(whole(hi[from], lo[from]), whole(hi[to], lo[to])));
        edges.insert({hi[from].x, hi[from].y, hi[from].z, lo[from].x, lo[from].y, lo[from].z, //
                      hi[to].x, hi[to].y, hi[to].z, lo[to].x, lo[to].y, lo[to].z});
      }
    }
    CHECK(sides == 36);
    CHECK(edges.size() == 18); // each twice
  }
}

TEST_CASE("nothing that blocks any light is left out") {
  Random random(44);
  int blocked = 0, left_out = 0;
  for (int i = 0; i < 40; ++i) {
    Sensor sensor;
    sensor.world_from_camera = random.pose(10.0);
    const Scene scene = random_mixture(random, sensor.world_from_camera);
    const CameraScene camera = to_camera(scene, sensor);
    std::vector<CameraIlluminator> lights(1);
    const glm::dvec3 middle = random.in_box({-1, -1, -1}, {1, 1, 1});
    for (int d = 0; d < 12; ++d)
      lights[0].diodes.push_back(diode_at(middle + 0.2 * random.unit_vector()));
    const Occluders occluders = find_occluders(camera, scene, lights);
    std::set<std::uint32_t> kept;
    for (const shader::Occluder &occluder : occluders.shapes)
      kept.insert(occluder.id);
    left_out += static_cast<int>(scene.shape_count() - kept.size());
    for (std::size_t t = 0; t < camera.triangles.size(); ++t)
      for (const Diode &diode : lights[0].diodes) {
        const glm::dvec3 point_m = point_of(camera.triangles[t], random);
        if (glm::dot(camera.planes[t].normal, diode.position_m) <= camera.planes[t].offset_m)
          continue;
        for (const auto *triangles : {&camera.triangles, &camera.hidden})
          for (const CameraTriangle &other : *triangles)
            if (other.id != camera.triangles[t].id &&
                is_between(other.corners_m, point_m, diode.position_m)) {
              ++blocked;
              REQUIRE(kept.contains(other.id));
            }
      }
  }
  CHECK(blocked > 1000);
  CHECK(left_out > 40);
}
