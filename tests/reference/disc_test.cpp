// Points of point clouds: discs that face the lens and count by the area that they cover.

#include "engine/reference/reference.h"
#include "engine/reference/view/ray_caster.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using reference::CameraDisc;
using reference::RayCaster;

namespace {

// Adds a disc with a surface and an object of its own about a place in the frame of a camera that stands as
// the world's node does.
void add_disc(Scene &scene, const glm::dvec3 &centre_m, double radius_m, const Surface &surface = {}) {
  scene.positions_m.push_back(node_from_camera().point(centre_m));
  scene.discs.push_back({static_cast<std::uint32_t>(scene.positions_m.size() - 1), radius_m,
                         static_cast<std::uint32_t>(scene.surfaces.size()),
                         static_cast<std::uint32_t>(scene.objects.size())});
  scene.surfaces.push_back(surface);
  scene.objects.push_back("disc");
}

Scene disc_at(const glm::dvec3 &centre_m, double radius_m, const Surface &surface = {}) {
  Scene scene;
  add_disc(scene, centre_m, radius_m, surface);
  return scene;
}

reference::Frame disc_frame(const Scene &scene, const Sensor &sensor, const Diode &diode = {},
                            Backscatter backscatter = Backscatter::lambert) {
  return reference::simulate(scene, sensor, {diode_beside_lens(sensor, diode)}, backscatter);
}

// Spans 1 m x 1 m at z = 1 m.
Sensor square_view() {
  Sensor sensor;
  sensor.resolution = {16, 16};
  sensor.samples = 16;
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(0.1 / 16);
  return sensor;
}

double mean(const std::vector<double> &values) {
  double sum = 0;
  for (const double value : values)
    sum += value;
  return sum / static_cast<double>(values.size());
}

} // namespace

TEST_CASE("a disc covers its area") {
  const double radius_m = 0.3;
  const auto frame = disc_frame(disc_at({0.03, -0.05, 1}, radius_m), square_view());
  // The view is a plane across the axis, the disc leans by its centre's slope: of the second order.
  const double slope = std::hypot(0.03, 0.05);
  CHECK(mean(frame.coverage) ==
        Approx(std::numbers::pi * radius_m * radius_m).epsilon(1e-3 + 2 * slope * slope));
  const auto on_axis = disc_frame(disc_at({0, 0, 1}, radius_m), square_view());
  CHECK(mean(on_axis.coverage) == Approx(std::numbers::pi * radius_m * radius_m).epsilon(1e-3));
}

TEST_CASE("a disc smaller than a pixel returns light by its share of the pixel") {
  const double z_m = 2, radius_m = 1e-3, pixel_m = 4e-3, intensity_w_sr = 3, rho = 0.7;
  Sensor sensor = axial_sensor();
  sensor.pixel_pitch_m = glm::dvec2(pixel_m / z_m);
  sensor.samples = 16;
  Diode diode;
  diode.intensity_w_sr = intensity_w_sr;
  const auto frame = disc_frame(disc_at({0, 0, z_m}, radius_m, {rho}), sensor, diode);
  // 52 of the 16 x 16 samples lie in a circle of 4 spacings about a corner of their grid.
  CHECK(frame.coverage[0] == 52 / 256.0);
  CHECK(frame.coverage[0] == Approx(std::numbers::pi * std::pow(radius_m / pixel_m, 2)).epsilon(0.05));
  CHECK(frame.returns[0].amplitude[0] ==
        Approx(frame.coverage[0] * rho / std::numbers::pi * intensity_w_sr / (z_m * z_m)).epsilon(1e-5));
  CHECK(frame.returns[0].distance_m[0] == Approx(z_m).epsilon(1e-6));
}

TEST_CASE("a disc faces the lens, wherever it stands") {
  Random random(21);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 axis = random.unit_vector(), centre_m = random.uniform(0.5, 4) * axis;
    const double radius_m = random.uniform(0.01, 2);
    const RayCaster caster({}, {{centre_m, radius_m}});
    const glm::dvec3 across = glm::normalize(glm::cross(axis, random.unit_vector()));
    const auto inside = caster.nearest(glm::normalize(centre_m + (1 - 1e-9) * radius_m * across));
    REQUIRE(inside);
    CHECK(inside->range_m == Approx(std::hypot(glm::length(centre_m), radius_m)).epsilon(1e-8));
    CHECK(glm::length(caster.normal(axis, 0) + axis) < 1e-15);
    CHECK_FALSE(caster.nearest(glm::normalize(centre_m + (1 + 1e-9) * radius_m * across)));
    CHECK_FALSE(caster.nearest(-axis));
  }
}

TEST_CASE("a disc's rim belongs to it") {
  // 3, 4, 5: everything here is exact.
  CHECK(reference::range_along({0.6, 0, 0.8}, CameraDisc{{0, 0, 4}, 3.0}) == 5.0);
  CHECK_FALSE(reference::range_along({0.6, 0, 0.8}, CameraDisc{{0, 0, 4}, std::nextafter(3.0, 0.0)}));
}

TEST_CASE("the light on a disc falls by the angle to the line to the lens") {
  const glm::dvec3 position_m(2, 0, 0);
  const auto frame = disc_frame(disc_at({0, 0, 2}, 0.5), axial_sensor(), diode_at(position_m));
  CHECK(frame.returns[0].amplitude[0] == Approx(std::sqrt(0.5) / std::numbers::pi / 8).epsilon(1e-5));
  CHECK(frame.returns[0].distance_m[0] == Approx((2 + std::sqrt(8)) / 2).epsilon(1e-6));
  // One behind the disc does not reach the side that the lens sees.
  CHECK(disc_frame(disc_at({0, 0, 2}, 0.5), axial_sensor(), diode_at({0, 0, 3})).returns[0].amplitude[0] ==
        0);
}

TEST_CASE("a disc hides what is behind it and is hidden by what is before it") {
  const double disc_m = GENERATE(1.0, 3.0);
  Scene scene = wall_at(2);
  add_disc(scene, {0, 0, disc_m}, 0.1);
  const auto frame = disc_frame(scene, axial_sensor());
  const bool disc_seen = disc_m < 2;
  CHECK(frame.triangle_id[0] == (disc_seen ? 2 : frame.triangle_id[0]));
  CHECK((frame.triangle_id[0] >= 2) == disc_seen);
  CHECK(frame.object_id[0] == (disc_seen ? 1u : 0u));
  CHECK(frame.range_m[0] == Approx(std::min(disc_m, 2.0)).epsilon(1e-10));
}

TEST_CASE("of discs the nearest is seen, of equal ones the lowest id, a triangle before a disc") {
  Scene scene = disc_at({0, 0, 2}, 0.5);
  add_disc(scene, {0, 0, 1.5}, 0.5);
  add_disc(scene, {0, 0, 1.5}, 0.5);
  add_disc(scene, {0.4, 0, 1}, 0.1); // beside the axis
  CHECK(disc_frame(scene, axial_sensor()).triangle_id[0] == 1);

  Sensor sensor = axial_sensor({1, 1});
  sensor.pixel_pitch_m = glm::dvec2(1e-30);
  SceneBuilder builder;
  builder.add_triangle({-9, -9, 1.5}, {-9, 9, 1.5}, {9, 0, 1.5});
  Scene touching = builder.scene();
  add_disc(touching, {0, 0, 1.5}, 0.5);
  CHECK(disc_frame(touching, sensor).triangle_id[0] == 0);
}

TEST_CASE("the nearest of many discs and triangles is the one that a search over all finds") {
  Random random(22);
  const Scene scene = random_triangles(random, 100, node_from_camera());
  const auto triangles = reference::triangles_in_camera(scene, Sensor{});
  std::vector<CameraDisc> discs;
  discs.reserve(300);
  for (int i = 0; i < 300; ++i)
    discs.push_back({random.in_box({-1.2, -1.2, 0.8}, {1.2, 1.2, 3}), random.uniform(0.01, 0.2)});
  const RayCaster caster(triangles, discs);
  int disc_hits = 0, disagreements = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 direction = glm::normalize(random.in_box({-0.7, -0.7, 1}, {0.7, 0.7, 1}));
    reference::Hit nearest{no_id, std::numeric_limits<double>::infinity()};
    for (std::uint32_t id = 0; id < triangles.size() + discs.size(); ++id) {
      const auto range_m = id < triangles.size()
                               ? reference::range_along(direction, triangles[id])
                               : reference::range_along(direction, discs[id - triangles.size()]);
      if (range_m && *range_m < nearest.range_m)
        nearest = {id, *range_m};
    }
    const auto hit = caster.nearest(direction);
    disagreements += (hit ? hit->id : no_id) != nearest.id;
    disc_hits += hit && hit->id >= triangles.size();
  }
  CHECK(disc_hits > 2000);
  CHECK(disagreements == 0);
}

TEST_CASE("a disc about the lens itself is not there") {
  Scene scene = disc_at({0, 0, 0}, 0.5);
  CHECK(disc_frame(scene, axial_sensor()).coverage[0] == 0);
  add_disc(scene, {0, 0, 1}, 0.5);
  const auto frame = disc_frame(scene, axial_sensor());
  CHECK(frame.triangle_id[0] == 1);
  CHECK(std::isfinite(frame.returns[0].amplitude[0]));
}

TEST_CASE("a disc has its vertex's colour") {
  Paint paint;
  paint.reflectivity_rgb = {0.5, 0.25, 0.125};
  paint.texture = std::make_shared<const Texture>(Texture{{2, 1}, {glm::vec4(1), {0.5f, 1, 0, 0.25f}}});
  paint.filter = TextureFilter::nearest;
  Scene scene = wall_at(3);
  add_disc(scene, {0, 0, 1}, 0.5, {0.125, false, paint});
  scene.texture_coordinates.resize(5, {0.25, 0.5});
  scene.texture_coordinates[4] = {0.75, 0.5};
  scene.colours.resize(5, glm::vec4(1));
  scene.colours[4] = {0.5f, 0.25f, 1, 1};
  const auto amplitude = [&] {
    return disc_frame(scene, axial_sensor(), {}, Backscatter::constant).returns[0].amplitude[0];
  };
  CHECK(amplitude() == Approx(0.125 + 0.5 * 0.25 + 0.25 * 0.25).epsilon(1e-10));
  // Its texel's alpha is 1/4.
  scene.surfaces.back().paint->alpha_cutoff = 0.25;
  CHECK(amplitude() == Approx(0.125 + 0.5 * 0.25 + 0.25 * 0.25).epsilon(1e-10));
  scene.surfaces.back().paint->alpha_cutoff = 0.26;
  CHECK(amplitude() == Approx(1 / 9.0).epsilon(1e-10));
}

TEST_CASE("discs stand where the camera's pose puts them") {
  Random random(23);
  const Pose world_from_camera = random.pose(5);
  Scene scene;
  scene.positions_m = {world_from_camera.point({0, 0, 7})};
  scene.discs = {{0, 0.01, 0, 0}};
  scene.surfaces = {{}};
  scene.objects = {"point"};
  Sensor sensor = axial_sensor();
  sensor.world_from_camera = world_from_camera;
  CHECK(disc_frame(scene, sensor).range_m[0] == Approx(7).epsilon(1e-10));
}
