// Which diodes light which sample: what blocks, what only touches, and that nothing leaks.

#include "engine/reference/reference.h"
#include "engine/reference/shadow/shadow_caster.h"
#include "engine/reference/view/ray_caster.h"
#include "tests/reference/shadow_fixture.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;
using reference::CameraDisc;
using reference::CameraTriangle;
using reference::DiodeSet;
using reference::Frame;
using reference::ShadowCaster;

namespace {

std::vector<glm::dvec3> ring(std::size_t count, double radius_m, double z_m = 0.0) {
  std::vector<glm::dvec3> positions_m;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    positions_m.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
  }
  return positions_m;
}

bool all_lit(const Frame &frame) {
  return std::all_of(frame.lit.begin(), frame.lit.end(), [](double lit) { return lit == 1; });
}

std::vector<reference::Light> lights_at(const std::vector<glm::dvec3> &positions_m) {
  reference::Light light{{}, 0.0};
  for (const glm::dvec3 &position_m : positions_m)
    light.diodes.push_back(diode_at(position_m));
  return {light};
}

// Whether light goes between two places, neither on any shape, in the frame of the lens at the origin.
bool is_free(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
             const glm::dvec3 &point_m, const glm::dvec3 &diode_m) {
  const ShadowCaster caster(triangles, discs, lights_at({diode_m}), 0.0);
  return caster.reached({point_m, glm::normalize(diode_m - point_m), 1.0, 1.0}, no_id).has(0);
}

// From its edge, the y axis, towards -x.
std::vector<CameraTriangle> half_plane(double z_m) {
  return {{{glm::dvec3(0, -20, z_m), {0, 20, z_m}, {-20, 0, z_m}}, false}};
}

// Around the origin, seen from outside; every quad between two circles and two meridians is flat.
void add_ball(SceneBuilder &builder, const glm::dvec3 &centre_m, double radius_m, std::uint32_t parts) {
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t i = 0; i <= parts; ++i)
    for (std::uint32_t j = 0; j < 2 * parts; ++j) {
      const double theta = std::numbers::pi * i / parts, phi = std::numbers::pi * j / parts;
      corners_m.push_back(centre_m + radius_m * glm::dvec3(std::sin(theta) * std::cos(phi),
                                                           std::sin(theta) * std::sin(phi), std::cos(theta)));
      const std::uint32_t here = i * 2 * parts + j, beside = i * 2 * parts + (j + 1) % (2 * parts);
      if (i < parts) {
        faces.push_back({here, here + 2 * parts, beside + 2 * parts});
        faces.push_back({here, beside + 2 * parts, beside});
      }
    }
  builder.add_mesh(corners_m, faces);
}

const std::vector<std::array<std::uint32_t, 3>> box_faces{
    {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
};

std::vector<glm::dvec3> box_corners(const Pose &pose, const glm::dvec3 &half_m) {
  std::vector<glm::dvec3> corners_m;
  for (int i = 0; i < 8; ++i)
    corners_m.push_back(pose.point(half_m * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return corners_m;
}

std::size_t in_front(const glm::dvec3 &point_m, const CameraTriangle &triangle,
                     const std::vector<Diode> &diodes) {
  const glm::dvec3 towards_lens = front_towards_lens(triangle, point_m);
  return static_cast<std::size_t>(std::count_if(diodes.begin(), diodes.end(), [&](const Diode &diode) {
    return glm::dot(towards_lens, diode.position_m - point_m) > 0;
  }));
}

// How many pixels of a single convex body are lit, and how many wrongly.
std::pair<int, int> convex_pixels(const Scene &scene, const Sensor &sensor, const Illuminator &light) {
  const Frame frame = frame_of(scene, sensor, {light});
  const auto triangles = reference::triangles_in_camera(scene, sensor);
  const auto diodes = reference::diodes_in_camera(light, sensor);
  int hits = 0, wrong = 0;
  for (std::uint32_t pixel = 0; pixel < frame.lit.size(); ++pixel)
    if (frame.coverage[pixel] > 0) {
      const std::size_t count =
          in_front(point_seen(sensor, frame, pixel), triangles[frame.triangle_id[pixel]], diodes);
      wrong += frame.lit[pixel] != static_cast<double>(count) / static_cast<double>(diodes.size());
      ++hits;
    }
  return {hits, wrong};
}

} // namespace

TEST_CASE("the penumbra of a half plane is the count of the diodes that clear its edge") {
  const double wall_m = 3, plane_m = 2, edge_m = 0.1;
  SceneBuilder builder;
  builder.add_wall({wall_m});
  builder.add_wall({plane_m, {}, {edge_m, -20}, {20, 20}});
  const Sensor sensor = wide_sensor({97, 3}, 0.3);
  const auto positions_m = ring(240, 0.15);
  const Frame frame = frame_of(builder.scene(), sensor, {diodes_at(sensor, positions_m)});
  int partly_lit = 0;
  for (std::uint32_t pixel = 0; pixel < frame.lit.size(); ++pixel) {
    const double x_m = point_seen(sensor, frame, pixel).x;
    std::vector<glm::dvec3> clear_m;
    for (const glm::dvec3 &diode_m : positions_m)
      if (frame.object_id[pixel] == 1 || glm::mix(diode_m.x, x_m, plane_m / wall_m) < edge_m)
        clear_m.push_back(diode_m);
    REQUIRE(frame.lit[pixel] == static_cast<double>(clear_m.size()) / 240);
    partly_lit += !clear_m.empty() && clear_m.size() < 240;
    if (pixel % 7 == 0 && !clear_m.empty()) {
      // The pixel as these diodes alone make it.
      const Frame alone = frame_of(builder.scene(), sensor, {diodes_at(sensor, clear_m)}, {});
      REQUIRE(frame.returns[0].z[pixel] == alone.returns[0].z[pixel]);
    }
  }
  CHECK(partly_lit > 20);
}

TEST_CASE("what a half plane leaves of a ring is summed as by hand") {
  // Half way to the diodes, so the ones beyond twice the edge's x are blocked: 90 + 2 * 41 degrees are left
  // of 1 diode a degree, 180 between -90 and 90 less those below 48.19 degrees on either side.
  SceneBuilder builder;
  builder.add_wall({2});
  builder.add_wall({1, {}, {0.05, -20}, {20, 20}});
  const Sensor sensor = axial_sensor();
  const auto on_ring_m = ring(360, 0.15);
  const Frame frame = frame_of(builder.scene(), sensor, {diodes_at(sensor, on_ring_m)});
  const double left = 360 - (2 * 48 + 1), diode_range_m = std::hypot(2, 0.15);
  CHECK(frame.lit[0] == left / 360);
  CHECK(frame.returns[0].amplitude[0] ==
        Approx(left / std::numbers::pi * 2 / std::pow(diode_range_m, 3)).epsilon(1e-10));
  CHECK(frame.returns[0].distance_m[0] == Approx((2 + diode_range_m) / 2).epsilon(1e-10));
}

TEST_CASE("a small plate hides the diode behind it and no other") {
  const bool towards_lens = GENERATE(true, false);
  SceneBuilder builder;
  builder.add_wall({2});
  const double top_m = towards_lens ? -0.1 : 0.1;
  builder.add_wall({1, {}, {0.4, top_m}, {0.6, -top_m}}); // turned over: culled, but there
  const Sensor sensor = axial_sensor();
  const glm::dvec3 behind_m(1, 0, 0), beside_m(0.7, 0, 0);
  const Frame both = frame_of(builder.scene(), sensor, {diodes_at(sensor, {behind_m, beside_m})});
  CHECK(both.lit[0] == 0.5);
  CHECK(both.sample_visibility == std::vector<std::uint32_t>{2});
  CHECK(both.returns[0].distance_m[0] == Approx((2 + std::hypot(2, 0.7)) / 2).epsilon(1e-10));

  const Frame dark = frame_of(builder.scene(), sensor, {diodes_at(sensor, {behind_m})});
  CHECK(dark.lit[0] == 0);
  CHECK(dark.returns[0].amplitude[0] == 0);
  CHECK(std::isnan(dark.returns[0].distance_m[0]));
  CHECK(dark.coverage[0] == 1);
}

TEST_CASE("a culled face between lens and point is not seen but hides the light beside the lens") {
  SceneBuilder builder;
  builder.add_wall({2});
  builder.add_wall({1, {}, {-0.1, 0.1}, {0.1, -0.1}});
  const Sensor sensor = axial_sensor();
  const Frame frame = frame_of(builder.scene(), sensor, {diodes_at(sensor, {{0, 0, 0}, {0.5, 0, 0}})});
  CHECK(frame.object_id[0] == 0);
  CHECK(frame.sample_visibility == std::vector<std::uint32_t>{2});
}

TEST_CASE("what lies beyond the diode, behind the point or beside the way does not block") {
  const glm::dvec3 point_m(0.01, 0.02, 2), diode_m(0.02, -0.01, 0.5);
  const auto plate = [&](double z_m, const glm::dvec2 &centre_m = {}) {
    SceneBuilder builder;
    builder.add_wall({z_m, {}, centre_m - 0.3, centre_m + 0.3});
    return reference::triangles_in_camera(builder.scene(), Sensor{});
  };
  for (const double z_m : {0.0, 0.499999, 2.000001, 3.0})
    CHECK(is_free(plate(z_m), {}, point_m, diode_m));
  for (const double z_m : {0.500001, 1.0, 1.999999})
    CHECK_FALSE(is_free(plate(z_m), {}, point_m, diode_m));
  CHECK(is_free(plate(1, {0.4, 0}), {}, point_m, diode_m));
}

TEST_CASE("a diode behind the surface does not reach, whatever stands between") {
  const Sensor sensor = axial_sensor();
  const Frame frame =
      frame_of(wall_at(2), sensor, {diodes_at(sensor, {{0, 0, 3}, {1, 0, 2}, {1, 0, 1.999999}})});
  CHECK(frame.sample_visibility == std::vector<std::uint32_t>{4});
  CHECK(frame.lit[0] == 1 / 3.0);
}

TEST_CASE("lit is the mean over the samples that hit, and no sample's bits are another's") {
  SceneBuilder builder;
  builder.add_wall({2, {}, {-1, -1}, {1, 0}}); // the upper half
  builder.add_wall({1, {}, {0.2, -1}, {1, 1}});
  Sensor sensor = wide_sensor({2, 1}, 0.1);
  sensor.samples = 2;
  // 35 diodes on the axis that reach all, and 5 that the plate hides from x > 0.05.
  const Illuminator first = diodes_at(sensor, std::vector<glm::dvec3>(35));
  const Illuminator second = diodes_at(sensor, std::vector<glm::dvec3>(5, {0.35, 0, 0}));
  const Frame frame = frame_of(builder.scene(), sensor, {first, second});
  // Columns at x = -0.075, -0.025, 0.025, 0.075 of the wall; the way crosses z = 1 at (0.35 + x) / 2.
  CHECK(frame.coverage == std::vector<double>{0.5, 0.5});
  CHECK(frame.lit[0] == 1);
  CHECK(frame.lit[1] == (40 + 35) / 80.0);
  const std::uint32_t all = ~0U;
  CHECK(frame.sample_visibility == std::vector<std::uint32_t>{all, 0xff, all, 0xff, all, 0xff, all, 7, //
                                                              0, 0, 0, 0, 0, 0, 0, 0});
  CHECK(reference::to_measurement(frame).lit == std::vector<float>{1.0f, 75 / 80.0f});
  CHECK(frame_of(builder.scene(), sensor, {first, second}, {Shadows::automatic}).sample_visibility.empty());
}

TEST_CASE("without shadows lit is empty, and where nothing blocks they change no bit") {
  Random random(31);
  const Pose world_from_camera = random.pose(5);
  const Sensor sensor = wide_sensor({24, 16}, 1, world_from_camera);
  const Illuminator light = random_illuminator(random, 40, world_from_camera);
  SceneBuilder builder(world_from_camera);
  builder.add_wall({2});
  const Frame off = frame_of(builder.scene(), sensor, {light}, {Shadows::off, true});
  CHECK(off.lit.empty());
  CHECK(off.sample_visibility.empty());
  CHECK(reference::to_measurement(off).lit.empty());
  const Frame on = frame_of(builder.scene(), sensor, {light});
  CHECK(all_lit(on));
  CHECK(std::memcmp(on.returns[0].z.data(), off.returns[0].z.data(),
                    off.returns[0].z.size() * sizeof(off.returns[0].z[0])) == 0);
}

TEST_CASE("shapes that coincide do not hide each other") {
  Random random(32);
  for (int i = 0; i < 20; ++i) {
    const Pose world_from_camera = random.pose(5);
    const Pose tilt = random.pose(0);
    SceneBuilder builder(world_from_camera);
    std::vector<glm::dvec3> corners_m;
    for (const glm::dvec2 &corner : {glm::dvec2(-9, -9), {-9, 9}, {9, 9}, {9, -9}})
      corners_m.push_back(tilt.point({corner, 0}) + glm::dvec3(0, 0, 2));
    // Cut along either diagonal, facing either way.
    builder.add_mesh(corners_m, {{0, 1, 2}, {0, 2, 3}}, {1.0, true});
    builder.add_mesh(corners_m, {{1, 0, 3}, {1, 3, 2}}, {1.0, true});
    const Sensor sensor = wide_sensor({17, 17}, 0.3, world_from_camera);
    // On the lens's side of the plane, as the lens itself.
    const Illuminator light = diodes_at(sensor, {{0, 0, 0}, {1e-3, 0, 0}, {0, -1e-3, 0}});
    const auto [hits, wrong] = convex_pixels(builder.scene(), sensor, light);
    CHECK(hits > 0);
    CHECK(wrong == 0);
  }
}

TEST_CASE("a convex body does not shadow itself") {
  Random random(33);
  const double origin_m = GENERATE(5.0, 1e7);
  for (int i = 0; i < 6; ++i) {
    const Pose world_from_camera = random.pose(origin_m);
    const Sensor sensor = wide_sensor({61, 61}, 0.8, world_from_camera);
    SceneBuilder ball(world_from_camera), box(world_from_camera);
    add_ball(ball, {0.05, -0.1, 2}, 0.6, 20);
    Pose turned = random.pose(0);
    turned.translation_m = {0.1, 0.05, 2};
    box.add_mesh(box_corners(turned, {0.4, 0.3, 0.35}), box_faces);
    const Illuminator light = diodes_at(sensor, ring(40, random.uniform(0.1, 2)));
    for (const SceneBuilder *builder : {&ball, &box}) {
      const auto [hits, wrong] = convex_pixels(builder->scene(), sensor, light);
      CHECK(hits > 500);
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("a closed box is lit everywhere from inside, its corners too") {
  Random random(34);
  const double origin_m = GENERATE(5.0, 1e7);
  for (int i = 0; i < 6; ++i) {
    const Pose world_from_camera = random.pose(origin_m);
    SceneBuilder builder(world_from_camera);
    auto inwards = box_faces;
    for (auto &face : inwards)
      std::swap(face[1], face[2]);
    builder.add_mesh(box_corners(random.pose(0.3), {1.5, 1.2, 2}), inwards);
    const Sensor sensor = wide_sensor({64, 64}, 3, world_from_camera);
    const Frame frame = frame_of(builder.scene(), sensor, {diodes_at(sensor, ring(48, 0.15))});
    CHECK(all_lit(frame));
  }
}

TEST_CASE("gaps down to a nanometre let no light under a plate and let it pass beside") {
  const glm::dvec3 diode_m(-2, 0.1, 0); // at 45 degrees
  for (const double gap_m : {1e-3, 1e-6, 1e-9})
    for (const double clear : {0.1, 0.5, 0.9, 1.1, 1.5, 5.0}) {
      const glm::dvec3 point_m(clear * gap_m, 0.1, 2);
      CAPTURE(gap_m, clear);
      CHECK(is_free(half_plane(2 - gap_m), {}, point_m, diode_m + glm::dvec3(clear * gap_m, 0, 0)) ==
            (clear > 1));
    }
}

TEST_CASE("diodes on a board are not hidden by it, wherever the world's origin is") {
  Random random(35);
  const double origin_m = GENERATE(0.0, 5.0, 1e7);
  for (int i = 0; i < 20; ++i) {
    const Pose world_from_camera = random.pose(origin_m);
    const Sensor sensor = wide_sensor({5, 5}, 0.5, world_from_camera);
    const auto lit_with_board_at = [&](double z_m) {
      SceneBuilder builder(world_from_camera);
      builder.add_wall({2});
      builder.add_wall({z_m, {}, {-0.3, -0.3}, {0.3, 0.3}});
      // Behind the lens, the diodes upon it: along its edges, over its diagonal and within.
      auto diodes_m = ring(24, 0.2, -0.01);
      diodes_m.insert(diodes_m.end(), {{0.3, 0.3, -0.01}, {-0.3, 0.1, -0.01}, {0.1, 0.1, -0.01}});
      return frame_of(builder.scene(), sensor, {diodes_at(sensor, diodes_m)}).lit;
    };
    CHECK(lit_with_board_at(-0.01) == std::vector<double>(25, 1.0));
    CHECK(lit_with_board_at(-0.01 - 1e-6) == std::vector<double>(25, 1.0));
    const auto hidden = lit_with_board_at(-0.01 + 1e-6);
    CHECK(*std::max_element(hidden.begin(), hidden.end()) <= 2 / 27.0); // those on the rim may see past it
  }
}

TEST_CASE("no light leaks through the edges and the hub of a fan") {
  Random random(36);
  int leaks = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto spokes = static_cast<std::uint32_t>(random.uniform(3, 12));
    const double turn = random.uniform(0, 7);
    const glm::dvec3 hub_m = random.in_box({-1, -1, 0.8}, {1, 1, 1.2});
    std::vector<glm::dvec3> rim_m = ring(spokes, random.uniform(0.05, 0.5));
    for (glm::dvec3 &rim : rim_m)
      rim = hub_m + glm::dvec3(std::cos(turn) * rim.x - std::sin(turn) * rim.y,
                               std::sin(turn) * rim.x + std::cos(turn) * rim.y, random.uniform(-0.02, 0.02));
    std::vector<CameraTriangle> fan;
    for (std::uint32_t j = 0; j < spokes; ++j)
      fan.push_back({{hub_m, rim_m[j], rim_m[(j + 1) % spokes]}, false});

    const glm::dvec3 point_m = random.in_box({-1, -1, 2}, {1, 1, 3});
    const double beyond = random.uniform(1.5, 2);
    const auto leaks_through = [&](const glm::dvec3 &place_m) {
      return is_free(fan, {}, point_m, point_m + beyond * (place_m - point_m));
    };
    leaks += leaks_through(hub_m);
    for (const glm::dvec3 &rim : rim_m)
      leaks += leaks_through(glm::mix(hub_m, rim, random.uniform(0.1, 0.9)));
  }
  CHECK(leaks == 0);
}

TEST_CASE("a mask blocks where it is opaque") {
  // The middle ninth is open.
  std::vector<glm::vec4> texels(9, glm::vec4(1));
  texels[4].a = 0.25f;
  Paint paint;
  paint.texture = std::make_shared<const Texture>(Texture{{3, 3}, texels});
  paint.filter = TextureFilter::nearest;
  paint.alpha_cutoff = 0.5;
  SceneBuilder builder;
  builder.add_wall(
      {1, {1.0, false, paint}, {0.15, -0.15}, {0.45, 0.15}}); // open 0.25 to 0.35 by -0.05 to 0.05
  builder.add_wall({2});
  Scene scene = builder.scene();
  scene.texture_coordinates = {{0, 0}, {0, 1}, {1, 1}, {1, 0}, {}, {}, {}, {}};
  const Sensor sensor = axial_sensor();
  const Frame frame = frame_of(scene, sensor,
                               {diodes_at(sensor, {{0.6, 0, 0},
                                                   {0.51, 0.09, 0},
                                                   {0.69, -0.09, 0},
                                                   {0.49, 0, 0},
                                                   {0.6, 0.11, 0},
                                                   {0.71, 0, 0},
                                                   {0.91, 0, 0}})});
  CHECK(frame.sample_visibility == std::vector<std::uint32_t>{0b1000111});
}

TEST_CASE("a disc blocks what passes within its radius, its rim included") {
  const glm::dvec3 point_m(0, 0, 2);
  const std::vector<CameraDisc> on_axis{{{0, 0, 1}, 0.25}};
  CHECK_FALSE(is_free({}, on_axis, point_m, {0.1, 0.2, 0}));
  CHECK_FALSE(is_free({}, on_axis, point_m, {0.5, 0, 0}));
  CHECK(is_free({}, on_axis, point_m, {std::nextafter(0.5, 1.0), 0, 0}));
  CHECK(is_free({}, on_axis, {0, 0, 0.9}, {0.1, 0, 0})); // behind the point
  CHECK(is_free({}, on_axis, point_m, {0.1, 0, 1}));     // upon it

  // Facing the lens, it leans: 45 degrees at (1, 0, 1), where the way along -x passes at an angle.
  const double radius_m = 0.1;
  const std::vector<CameraDisc> leaning{{{1, 0, 1}, radius_m}};
  for (const double share : {-1.0 - 1e-9, -1.0 + 1e-9, 1.0 - 1e-9, 1.0 + 1e-9}) {
    const double z_m = 1 + share * radius_m * std::sqrt(0.5);
    CHECK(is_free({}, leaning, {3, 0, z_m}, {-2, 0, z_m}) == (std::abs(share) > 1));
  }
  CHECK(is_free({}, {{{0, 0, 0}, 1.0}}, point_m, {0, 0, -1})); // about the lens: not there
}

TEST_CASE("a disc does not hide itself, and shows its id among the triangles'") {
  Scene scene = wall_at(2);
  scene.surfaces.emplace_back();
  scene.objects.emplace_back("disc");
  for (const glm::dvec3 &centre_m : {glm::dvec3(0.3, 0.1, 1), glm::dvec3(0.3, 0.1, 0.5)}) {
    scene.positions_m.push_back(node_from_camera().point(centre_m));
    scene.discs.push_back({static_cast<std::uint32_t>(scene.positions_m.size() - 1), 0.1, 1, 1});
  }
  const Sensor sensor = wide_sensor({41, 41}, 1);
  const Frame near_lens = frame_of(scene, sensor, {diodes_at(sensor, {{1e-4, 0, 0}})});
  std::size_t on_discs = 0;
  for (std::size_t pixel = 0; pixel < near_lens.lit.size(); ++pixel)
    if (near_lens.triangle_id[pixel] >= 2) {
      CHECK(near_lens.lit[pixel] == 1);
      ++on_discs;
    }
  CHECK(on_discs > 10);
}

TEST_CASE("small shapes close to the lens are not lost from diodes far away") {
  Random random(39);
  std::vector<CameraTriangle> triangles;
  std::vector<glm::dvec3> centres_m;
  const double half_m = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 &centre_m =
        centres_m.emplace_back(random.in_box({-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}));
    triangles.push_back({{centre_m + half_m * glm::dvec3(-1, -1, 0), centre_m + half_m * glm::dvec3(1, -1, 0),
                          centre_m + half_m * glm::dvec3(0, 2, 0)},
                         false});
  }
  int leaks = 0;
  for (const glm::dvec3 &centre_m : centres_m) {
    const glm::dvec3 point_m = random.in_box({-1, -1, 1}, {1, 1, 2});
    const double beyond = random.uniform(1e3, 1e4);
    leaks += is_free(triangles, {}, point_m, point_m + beyond * (centre_m - point_m));
  }
  CHECK(leaks == 0);
}

TEST_CASE("a shape never blocks its own points") {
  const auto triangles = half_plane(1);
  const ShadowCaster caster(triangles, {}, lights_at({{-1, 0, 0}}), 0.0);
  const reference::SurfacePoint point{{-1, 0, 2}, {0, 0, -1}, 1.0, 1.0};
  CHECK(caster.reached(point, 0).has(0));
  CHECK_FALSE(caster.reached(point, no_id).has(0));
}
