// The record of a triangle for the points passes: its plane and where rays can meet it.

#include "engine/light/camera_light.h"
#include "engine/view/camera_scene.h"

#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Triangles {
  Scene scene;
  CameraScene camera;
};

// Around the lens, to all sides, and some of them large: the lens stands over or beside them.
Triangles triangles_around(Random &random) {
  SceneBuilder builder;
  for (int i = 0; i < 200; ++i) {
    const double size_m = random.flip() ? 0.3 : 4.0;
    const glm::dvec3 centre_m = random.uniform(0.5, 3) * random.unit_vector();
    const auto corner_m = [&] { return centre_m + size_m * random.unit_vector(); };
    const glm::dvec3 a = corner_m(), b = corner_m(), c = corner_m();
    builder.add_triangle(a, b, c, {random.uniform(0, 1), true});
  }
  return {builder.scene(), to_camera(builder.scene(), Sensor())};
}

glm::dvec3 point_of(const CameraTriangle &triangle, Random &random) {
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto &[a, b, c] = triangle.corners_m;
  return a + u * (b - a) + v * (c - a);
}

} // namespace

TEST_CASE("ranges and depths of a triangle's points are within its bounds") {
  Random random(31);
  const auto [scene, camera] = triangles_around(random);
  REQUIRE(camera.triangles.size() == 200);
  const auto by_range = triangle_planes(camera, scene, Backscatter::constant, AlongRay::range);
  const auto by_depth = triangle_planes(camera, scene, Backscatter::constant, AlongRay::depth);
  for (const CameraTriangle &triangle : camera.triangles)
    for (int i = 0; i < 500; ++i) {
      const glm::dvec3 point_m = point_of(triangle, random);
      const double range_m = glm::length(point_m), depth_m = std::max(0.0, point_m.z);
      REQUIRE(by_range[triangle.id].along_min <= range_m);
      REQUIRE(by_range[triangle.id].along_max >= range_m);
      REQUIRE(by_depth[triangle.id].along_min <= depth_m);
      REQUIRE(by_depth[triangle.id].along_max >= depth_m);
    }
}

TEST_CASE("bounds along the ray are no wider than the triangle") {
  const auto bounds_of = [](const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
    SceneBuilder builder;
    builder.add_triangle(a, b, c, {1.0, true});
    const CameraScene camera = to_camera(builder.scene(), Sensor());
    const auto planes = triangle_planes(camera, builder.scene(), Backscatter::constant, AlongRay::range);
    return std::pair<double, double>(planes[0].along_min, planes[0].along_max);
  };
  const auto is = [](const std::pair<double, double> &bounds, double nearest_m, double farthest_m) {
    return bounds.first == Approx(nearest_m).epsilon(2e-6) &&
           bounds.second == Approx(farthest_m).epsilon(2e-6);
  };
  // The lens over the triangle, before an edge, and before a corner.
  CHECK(is(bounds_of({-1, -1, 2}, {3, -1, 2}, {-1, 3, 2}), 2.0, std::sqrt(14.0)));
  CHECK(is(bounds_of({1, -1, 2}, {1, 1, 2}, {4, 0, 2}), std::sqrt(5.0), std::sqrt(20.0)));
  CHECK(is(bounds_of({1, 1, 2}, {2, 1, 2}, {1, 2, 2}), std::sqrt(6.0), 3.0));
}

TEST_CASE("planes turn to the lens, and hold their triangles") {
  Random random(32);
  const auto [scene, camera] = triangles_around(random);
  const auto planes = triangle_planes(camera, scene, Backscatter::lambert, AlongRay::range);
  for (const CameraTriangle &triangle : camera.triangles) {
    const shader::TrianglePlane &plane = planes[triangle.id];
    const glm::dvec4 sum = glm::dvec4(plane.plane_hi) + glm::dvec4(plane.plane_lo);
    REQUIRE(sum.w < 0.0);
    REQUIRE(glm::length(glm::dvec3(sum)) == Approx(1.0).epsilon(1e-13));
    for (const glm::dvec3 &corner_m : triangle.corners_m)
      REQUIRE(std::abs(glm::dot(glm::dvec3(sum), corner_m) - sum.w) < 1e-12);
    const double reflectivity = scene.surfaces[scene.triangles[triangle.id].surface].reflectivity;
    REQUIRE(plane.backscatter == Approx(reflectivity / std::numbers::pi));
    REQUIRE(plane.object == scene.triangles[triangle.id].object);
  }
}

TEST_CASE("what the lens cannot see is kept apart, what has no area is left out") {
  SceneBuilder builder;
  builder.add_triangle({0, 0, 2}, {0, 1, 2}, {1, 0, 2});              // front
  builder.add_triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2});              // back, one-sided
  builder.add_triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1.0, true}); // back, two-sided
  builder.add_triangle({0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {1.0, true}); // edge-on
  builder.add_triangle({0, 0, 2}, {1, 1, 2}, {2, 2, 2}, {1.0, true}); // no area
  const CameraScene camera = to_camera(builder.scene(), Sensor());
  REQUIRE(camera.triangles.size() == 2);
  CHECK(camera.triangles[0].id == 0);
  CHECK(camera.triangles[1].id == 2);
  CHECK(camera.planes.size() == 2);
  REQUIRE(camera.hidden.size() == 2);
  CHECK(camera.hidden[0].id == 1);
  CHECK(camera.hidden[1].id == 3);
  CHECK(camera.hidden[1].corners_m[2] == glm::dvec3(1, 0, 2));
}

TEST_CASE("every shape with an area is either seen or hidden, wherever it stands") {
  Random random(34);
  Sensor sensor;
  sensor.world_from_camera = random.pose(5.0);
  SceneBuilder builder(sensor.world_from_camera);
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 at = 3.0 * random.unit_vector(); // behind the lens as well
    builder.add_triangle(at, at + random.unit_vector(), at + random.unit_vector(), {1.0, random.flip()});
  }
  const CameraScene camera = to_camera(builder.scene(), sensor);
  CHECK(camera.hidden.size() > 50);
  std::vector<int> times(300);
  for (const auto *triangles : {&camera.triangles, &camera.hidden})
    for (const CameraTriangle &triangle : *triangles)
      ++times[triangle.id];
  CHECK(times == std::vector<int>(300, 1));
  for (const CameraTriangle &triangle : camera.hidden) {
    CHECK_FALSE(builder.scene().surfaces[builder.scene().surface_of(triangle.id)].double_sided);
    const auto front = front_plane(triangle.corners_m);
    REQUIRE(front);
    CHECK(front->offset_m > 0.0); // its front turns away from the lens
  }
}

TEST_CASE("a disc faces the lens: it is seen, never hidden") {
  Scene scene;
  scene.positions_m = {{0, 0, -2}, {3, 1, 4}, {0, 0, 0}}; // before the lens, behind it, in it
  scene.surfaces.emplace_back();
  scene.objects.emplace_back("points");
  for (std::uint32_t vertex = 0; vertex < 3; ++vertex)
    scene.discs.push_back({vertex, 0.1, 0, 0});
  const CameraScene camera = to_camera(scene, Sensor());
  CHECK(camera.triangles.size() == 2);
  CHECK(camera.hidden.empty());
}

TEST_CASE("an illuminator's diodes come into the camera frame with their axes and what lies across them") {
  Random random(33);
  Sensor sensor;
  sensor.world_from_camera = random.pose(10.0);
  Illuminator light{"light", random.pose(10.0), {diode_at({0.1, 0.2, 0.3})}, 0.5};
  light.diodes[0].axis = {0, 0, 1};
  light.diodes[0].across = {0, 1, 0};
  const auto seen = to_camera({light, light}, sensor);
  REQUIRE(seen.size() == 2);
  CHECK(seen[1].modulation_phase_rad == 0.5);
  const Diode &diode = seen[1].diodes[0];
  const auto same = [](const glm::dvec3 &a, const glm::dvec3 &b) { return glm::distance(a, b) < 1e-12; };
  const Pose &camera = sensor.world_from_camera, &frame = light.world_from_illuminator;
  CHECK(same(camera.point(diode.position_m), frame.point({0.1, 0.2, 0.3})));
  CHECK(same(camera.direction(diode.axis), frame.direction({0, 0, 1})));
  CHECK(same(camera.direction(diode.across), frame.direction({0, 1, 0})));
}

TEST_CASE("lights far apart do not make each other's surfaces ask which way they face") {
  const CameraScene camera = to_camera(wall_at(2), Sensor());
  const auto lit_by = [&](const std::vector<glm::dvec3> &places) {
    std::vector<CameraIlluminator> lights;
    for (const glm::dvec3 &place : places)
      lights.push_back({{diode_at(place)}});
    return all_face_the_light(camera, lights);
  };
  CHECK(lit_by({{-5, 0, 0}, {5, 0, 0}})); // a sphere around both would reach behind the wall
  CHECK_FALSE(lit_by({{-5, 0, 0}, {5, 0, 2.5}}));
}
