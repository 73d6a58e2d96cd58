// Which diodes light which point, by hand: what a straight line from a diode passes on its way to a wall.

#include "tests/comparison/engines.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double wall_m = 2.0;
// The shadow's edge may fall on either side of a line that passes it as close as this.
constexpr double edge_tolerance_m = 10e-6;

// The sensor of all tests here. It sees the wall from -0.6 to 0.6 m and a bit, in 96 x 72 pixels.
Sensor wall_sensor() {
  Sensor sensor;
  sensor.resolution = {96, 72};
  sensor.pixel_pitch_m = {3e-4, 4e-4};
  sensor.focal_length_m = 0.0471;
  return sensor;
}

// Where a pixel's ray meets the plane z = 2 m, camera frame.
glm::dvec3 on_wall(const Sensor &sensor, std::size_t pixel) {
  const glm::uvec2 place(pixel % sensor.resolution.x, pixel / sensor.resolution.x);
  const glm::dvec2 from_centre = glm::dvec2(place) + 0.5 - 0.5 * glm::dvec2(sensor.resolution);
  return {from_centre * sensor.pixel_pitch_m / sensor.focal_length_m * wall_m, wall_m};
}

Illuminator diodes_at(const Sensor &sensor, const std::vector<glm::dvec3> &places_m) {
  Illuminator illuminator{"diodes", sensor.world_from_camera, {}};
  for (const glm::dvec3 &place_m : places_m)
    illuminator.diodes.push_back(diode_at(place_m));
  return illuminator;
}

// The paper's five rings of 48 about a place, across the optical axis.
std::vector<glm::dvec3> ring_about(const glm::dvec3 &centre_m) {
  std::vector<glm::dvec3> places_m;
  for (const double radius_m : {0.126, 0.136, 0.146, 0.156, 0.166})
    for (int k = 0; k < 48; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / 48;
      places_m.push_back(centre_m + radius_m * glm::dvec3(std::cos(angle), std::sin(angle), 0));
    }
  return places_m;
}

Measurement measure_shadows(Engine engine, const Scene &scene, const Sensor &sensor,
                            const std::vector<glm::dvec3> &diodes_m) {
  Measurement measured = measure(engine, scene, sensor, diodes_at(sensor, diodes_m), Backscatter::lambert, {},
                                 Shadows::automatic);
  REQUIRE(measured.lit.size() == sensor.pixel_count());
  return measured;
}

// `lit` of every pixel against 1 where the only diode should reach, 0 where it should not, and nothing where
// that is too close to say; the returns beside it. Returns how many pixels are bright and dark.
struct Count {
  std::size_t bright = 0, dark = 0;
};
Count check_one_diode(Engine engine, const std::string &name, const Measurement &measured,
                      const std::function<double(std::size_t)> &inside_m) {
  Count count;
  std::size_t wrong = 0;
  for (std::size_t pixel = 0; pixel < measured.lit.size(); ++pixel) {
    const double clearance_m = inside_m(pixel);
    if (std::abs(clearance_m) <= edge_tolerance_m)
      continue;
    const bool bright = clearance_m < 0;
    ++(bright ? count.bright : count.dark);
    const Return &seen = measured.returns[0];
    wrong += measured.lit[pixel] != (bright ? 1.0f : 0.0f) || (seen.amplitude[pixel] > 0) != bright ||
             std::isnan(seen.distance_m[pixel]) == bright || std::isnan(seen.phase_rad[pixel]) == bright;
  }
  check_within(engine, name + ", wrong pixels", 0, static_cast<double>(wrong), 0);
  return count;
}

constexpr double everywhere_dark = 1.0, everywhere_bright = -1.0;

void check_same_everywhere(Engine engine, const std::string &name, const Measurement &measured,
                           double everywhere) {
  for (const float coverage : measured.coverage)
    REQUIRE(coverage == 1);
  check_one_diode(engine, name, measured, [&](std::size_t) { return everywhere; });
}

// Half of a plane, its edge, and how far it reaches from there to the right.
struct HalfPlane {
  glm::dvec3 edge_from_m, edge_to_m;
  double reach_m = 9.0;

  // Above 0 where the line passes through the half-plane, below where it is free; either way how far from
  // the edge's line it passes.
  double inside_m(const glm::dvec3 &from_m, const glm::dvec3 &to_m) const {
    const glm::dvec3 across = glm::cross(to_m - from_m, edge_to_m - edge_from_m);
    return glm::dot(across, edge_from_m - from_m) / glm::length(across);
  }
  void add_to(SceneBuilder &builder) const {
    const glm::dvec3 right(reach_m, 0, 0);
    builder.add_mesh({edge_from_m, edge_to_m, edge_to_m + right, edge_from_m + right}, {{0, 1, 2}, {0, 2, 3}},
                     {0.3, true});
  }
};

// The values of a pixel that sees a wall of reflectivity 1 across the axis, lit by diodes of 1 W/sr.
struct Expected {
  double lit, distance_m;
};
Expected expected_at(const glm::dvec3 &point_m, const Sensor &sensor,
                     const std::vector<glm::dvec3> &reaching_m, std::size_t diodes) {
  std::complex<double> z = 0.0;
  for (const glm::dvec3 &diode_m : reaching_m) {
    const double r_m = glm::length(point_m - diode_m);
    const double cosine = (point_m.z - diode_m.z) / r_m;
    const double phase_rad = std::numbers::pi * (r_m + glm::length(point_m)) / sensor.ambiguity_m();
    z += std::polar(cosine / std::numbers::pi / (r_m * r_m), phase_rad);
  }
  return {static_cast<double>(reaching_m.size()) / static_cast<double>(diodes),
          std::arg(z) / (2 * std::numbers::pi) * sensor.ambiguity_m()};
}

struct Penumbra {
  std::size_t bright = 0, penumbra = 0, dark = 0, too_close = 0;
  double lit_error = 0.0, distance_error_m = 0.0;
};

void compare_pixel(Penumbra &penumbra, const Measurement &measured, std::size_t pixel,
                   const Expected &expected) {
  const double lit = measured.lit[pixel], distance_m = measured.returns[0].distance_m[pixel];
  penumbra.lit_error = std::max(penumbra.lit_error, std::abs(lit - expected.lit));
  if (expected.lit == 0) {
    ++penumbra.dark;
    CHECK(std::isnan(distance_m));
    CHECK(measured.returns[0].amplitude[pixel] == 0);
    return;
  }
  ++(expected.lit == 1 ? penumbra.bright : penumbra.penumbra);
  const double error_m = std::abs(distance_m - expected.distance_m);
  penumbra.distance_error_m = std::max(
      penumbra.distance_error_m, std::isnan(error_m) ? std::numeric_limits<double>::infinity() : error_m);
}

// Over the pixels that see the wall past the half-plane.
Penumbra compare_penumbra(const Measurement &measured, const Sensor &sensor, const HalfPlane &half_plane,
                          const std::vector<glm::dvec3> &diodes_m) {
  Penumbra penumbra;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    const glm::dvec3 point_m = on_wall(sensor, pixel);
    double closest_m = -half_plane.inside_m(glm::dvec3(0), point_m);
    if (closest_m < 0)
      continue; // sees the half-plane
    std::vector<glm::dvec3> reaching_m;
    for (const glm::dvec3 &diode_m : diodes_m) {
      const double inside_m = half_plane.inside_m(diode_m, point_m);
      closest_m = std::min(closest_m, std::abs(inside_m));
      if (inside_m < 0)
        reaching_m.push_back(diode_m);
    }
    if (closest_m <= edge_tolerance_m)
      ++penumbra.too_close;
    else
      compare_pixel(penumbra, measured, pixel, expected_at(point_m, sensor, reaching_m, diodes_m.size()));
  }
  return penumbra;
}

} // namespace

TEST_CASE("the penumbra of a half-plane between ring and wall") {
  const Engine engine = both_engines();
  const auto [name, half_plane] = GENERATE(
      table<std::string, HalfPlane>({{"edge parallel to the wall", {{0.4, -4, 1}, {0.2, 4, 1}}},
                                     {"edge towards the wall", {{0.31, -4, 0.6}, {0.27, 4, 1.4}}},
                                     {"edge close to the wall", {{0.29, -4, 1.9}, {0.31, 4, 1.9}}}}));
  const Sensor sensor = wall_sensor();
  const std::vector<glm::dvec3> diodes_m = ring_about({0.5, 0, 0});
  SceneBuilder builder;
  builder.add_wall({wall_m});
  half_plane.add_to(builder);
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, diodes_m);
  const Penumbra penumbra = compare_penumbra(measured, sensor, half_plane, diodes_m);
  check_within(engine, name + ", lit", 0, penumbra.lit_error, 1e-6);
  check_within(engine, name + ", distance", 0, penumbra.distance_error_m, 2e-6);
  CHECK(penumbra.bright > 500);
  CHECK(penumbra.penumbra > 50);
  CHECK(penumbra.too_close < 500);
}

TEST_CASE("the shadow of one diode has a sharp edge") {
  const Engine engine = both_engines();
  Sensor sensor = wall_sensor();
  sensor.resolution = {640, 1};
  sensor.pixel_pitch_m = {45e-6, 45e-6};
  const HalfPlane half_plane{{0.3, -4, 1}, {0.3, 4, 1}};
  const glm::dvec3 diode_m(0.5, 0.02, 0);
  SceneBuilder builder;
  builder.add_wall({wall_m});
  half_plane.add_to(builder);
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, {diode_m});
  // At x = 2 * 0.3 - 0.5 = 0.1 m of the wall; the half-plane itself, from x = 0.6 m, is seen and lit.
  const Count count = check_one_diode(engine, "one diode's edge", measured, [&](std::size_t pixel) {
    const double x_m = on_wall(sensor, pixel).x;
    return x_m > 0.6 ? everywhere_bright : x_m - 0.1;
  });
  CHECK(count.dark > 100);
  CHECK(count.bright > 100);
}

TEST_CASE("the shadow's edge is in its place to ten micrometres") {
  const Engine engine = both_engines();
  const auto [name, scale, reach_m] =
      GENERATE(table<std::string, double, double>({{"of 10 m at 1 m", 1, 10},
                                                   {"of 1 km at 1 m", 1, 1000},
                                                   {"of 1 m at 5 cm", 0.05, 1},
                                                   {"of 30 m at 5 m", 5, 30}}));
  Sensor sensor = axial_sensor({400, 1});
  sensor.pixel_pitch_m = glm::dvec2(2e-6 / scale); // 4 micrometres on the wall
  const glm::dvec3 diode_m(0.6 * scale, 0.1 * scale, 0);
  const glm::dvec3 on_edge_m(0.3 * scale, 0.05 * scale, scale), along_m = reach_m * glm::dvec3(0.3, 1, 0.013);
  const HalfPlane half_plane{on_edge_m - along_m, on_edge_m + 0.7 * along_m, reach_m};
  SceneBuilder builder;
  builder.add_wall({wall_m * scale});
  half_plane.add_to(builder);
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, {diode_m});
  const Count count =
      check_one_diode(engine, "the edge of a plate " + name, measured, [&](std::size_t pixel) {
        return half_plane.inside_m(diode_m, scale * on_wall(sensor, pixel));
      });
  CHECK(count.dark > 180);
  CHECK(count.bright > 180);
}

TEST_CASE("a gap of a tenth of a millimetre is no contact") {
  const Engine engine = both_engines();
  Sensor sensor = axial_sensor({64, 1});
  sensor.pixel_pitch_m = {3e-6, 3e-6}; // 6 micrometres on the wall
  const double gap_m = 1e-4;
  SceneBuilder builder;
  builder.add_wall({wall_m});
  builder.add_wall({wall_m - gap_m, {}, {0, -10}, {10, 10}});
  const glm::dvec3 diode_m(wall_m, 0, 0); // at 45 degrees: the shadow is as wide as the gap
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, {diode_m});
  const Count count = check_one_diode(engine, "a gap's shadow", measured, [&](std::size_t pixel) {
    const double x_m = on_wall(sensor, pixel).x;
    return x_m > 0 ? everywhere_bright : x_m + gap_m;
  });
  CHECK(count.dark >= 13);
  CHECK(count.bright > 40);
}

TEST_CASE("what lies behind the diode or behind the wall blocks nothing") {
  const Engine engine = both_engines();
  const glm::dvec3 diode_m(0.1, -0.05, 0.2);
  const double behind_m = GENERATE(0.199, 2.001, -1.0, 3.0);
  SceneBuilder builder;
  builder.add_wall({wall_m});
  // The lens does not see it: it is beside the view, or behind the wall.
  builder.add_wall({behind_m, {1.0, true}, {behind_m < 1 ? 0.08 : -9.0, -9}, {9, 9}});
  const Measurement measured = measure_shadows(engine, builder.scene(), wall_sensor(), {diode_m});
  std::size_t not_lit = 0;
  for (std::size_t pixel = 0; pixel < measured.lit.size(); ++pixel)
    not_lit += measured.triangle_id[pixel] < 2 && measured.lit[pixel] != 1;
  check_within(engine, fmt::format("a plate at {} m, wrong pixels", behind_m), 0,
               static_cast<double>(not_lit), 0);
}

TEST_CASE("what lies just before the diode or just before the wall blocks all") {
  const Engine engine = both_engines();
  const glm::dvec3 diode_m(0.1, -0.05, 0.2);
  const double before_m = GENERATE(0.2001, 1.0, 1.9999);
  SceneBuilder builder;
  builder.add_wall({wall_m});
  // Its back to the lens, which sees through it.
  builder.add_mesh({{-9, -9, before_m}, {9, -9, before_m}, {9, 9, before_m}, {-9, 9, before_m}},
                   {{0, 1, 2}, {0, 2, 3}}, {1.0, false});
  const Measurement measured = measure_shadows(engine, builder.scene(), wall_sensor(), {diode_m});
  check_same_everywhere(engine, fmt::format("a culled plate at {} m", before_m), measured, everywhere_dark);
  CHECK(*std::max_element(measured.triangle_id.begin(), measured.triangle_id.end()) < 2);
}

TEST_CASE("light falls through the holes of a mask") {
  const Engine engine = both_engines();
  Texture texture{{4, 4}, std::vector<glm::vec4>(16, {1, 1, 1, 1})};
  texture.texels[4 * 2 + 1].a = 0.2f; // from 1/4 to 2/4 in u, 2/4 to 3/4 in v
  Surface cutouts{0.0, false, Paint{glm::dvec3(0.5)}};
  cutouts.paint->texture = std::make_shared<const Texture>(std::move(texture));
  cutouts.paint->filter = TextureFilter::nearest;
  cutouts.paint->alpha_cutoff = 0.5;
  SceneBuilder builder;
  builder.add_wall({wall_m});
  // Its back to the lens. u runs to the right, v down, 1.6 m long both.
  builder.add_mesh({{-0.8, -0.8, 1}, {0.8, -0.8, 1}, {0.8, 0.8, 1}, {-0.8, 0.8, 1}}, {{0, 1, 2}, {0, 2, 3}},
                   cutouts);
  Scene scene = builder.scene();
  scene.texture_coordinates = {{}, {}, {}, {}, {0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const glm::dvec2 hole_from_m(-0.4, 0.0), hole_to_m(0.0, 0.4);

  const Sensor sensor = wall_sensor();
  const glm::dvec3 diode_m(-0.3, 0.2, 0);
  const Measurement measured = measure_shadows(engine, scene, sensor, {diode_m});
  const Count count = check_one_diode(engine, "a hole of a mask", measured, [&](std::size_t pixel) {
    const glm::dvec2 crossing_m = 0.5 * glm::dvec2(on_wall(sensor, pixel) + diode_m);
    const glm::dvec2 beyond_m = glm::max(hole_from_m - crossing_m, crossing_m - hole_to_m);
    return std::max(beyond_m.x, beyond_m.y);
  });
  CHECK(count.bright > 1000);
  CHECK(count.dark > 1000);
}

TEST_CASE("a point throws the shadow of a disc") {
  const Engine engine = both_engines();
  Scene scene = wall_at(wall_m);
  scene.discs = {{4, 0.1, 0, 0}};
  scene.positions_m.push_back(node_from_camera().point({0, 0, 1}));
  const Sensor sensor = wall_sensor();
  const glm::dvec3 diode_m(0.4, 0.1, 0);
  const Measurement measured = measure_shadows(engine, scene, sensor, {diode_m});
  const Count count = check_one_diode(engine, "a disc's shadow", measured, [&](std::size_t pixel) {
    const glm::dvec2 crossing_m = 0.5 * glm::dvec2(on_wall(sensor, pixel) + diode_m);
    const bool sees_disc = measured.triangle_id[pixel] == 2;
    return sees_disc ? everywhere_bright : 0.1 - glm::length(crossing_m);
  });
  CHECK(count.dark > 400);
}

TEST_CASE("wall and floor light up to the corner between them") {
  const Engine engine = both_engines();
  const bool welded = GENERATE(true, false);
  SceneBuilder builder;
  const std::vector<glm::dvec3> corners_m{{-3, 0.25, 0.1}, {3, 0.25, 0.1}, {-3, 0.25, 2},
                                          {3, 0.25, 2},    {-3, -3, 2},    {3, -3, 2}};
  const std::array<std::uint32_t, 3> floor_near{0, 1, 3}, floor_far{0, 3, 2}, wall_low{2, 3, 5},
      wall_high{2, 5, 4};
  if (welded)
    builder.add_mesh(corners_m, {floor_near, floor_far, wall_low, wall_high}, {0.5, true});
  else {
    builder.add_mesh(corners_m, {floor_near, floor_far}, {0.5, true});
    builder.add_mesh(corners_m, {wall_low, wall_high}, {0.5, true});
  }
  Sensor sensor = wall_sensor();
  sensor.resolution.y = 73; // a row of pixels looks right into the corner, or half a pixel beside it
  sensor.pixel_pitch_m.y = GENERATE(4e-4, 0.25 / wall_m * 0.0471 / 15);
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, ring_about(glm::dvec3(0)));
  check_same_everywhere(engine, welded ? "a welded corner" : "a corner of two meshes", measured,
                        everywhere_bright);
  CHECK(*std::max_element(measured.triangle_id.begin(), measured.triangle_id.end()) >= 2);
}

TEST_CASE("faces back to back in the same place do not shade each other") {
  const Engine engine = both_engines();
  SceneBuilder builder;
  const std::vector<glm::dvec3> corners_m{
      {-3.1, -2.3, 1.2}, {-2.9, 2.7, 1.9}, {3.3, 2.1, 2.8}, {3.2, -2.2, 1.7}};
  builder.add_mesh(corners_m, {{0, 1, 2}, {0, 2, 3}}, {0.5, false});
  builder.add_mesh(corners_m, {{2, 1, 0}, {3, 2, 0}}, {0.5, false});
  const Measurement measured =
      measure_shadows(engine, builder.scene(), wall_sensor(), ring_about(glm::dvec3(0)));
  check_same_everywhere(engine, "faces back to back", measured, everywhere_bright);
}

TEST_CASE("faces in one plane do not shade each other") {
  const Engine engine = both_engines();
  const double reach_m = GENERATE(0.0, 10.0, 1e5);
  Random random(11);
  Sensor sensor = wall_sensor();
  sensor.world_from_camera = random.pose(reach_m);
  const glm::dvec3 u_m(3.1, 0.3, 0.7), v_m(-0.2, 2.9, 0.5), centre_m(0, 0, 2);
  SceneBuilder builder(sensor.world_from_camera);
  for (int k = 0; k < 30; ++k) { // the first fills the view
    const double size = k == 0 ? 1.0 : random.uniform(0.02, 0.3);
    const double along_u = k == 0 ? 0.0 : random.uniform(-0.2, 0.2);
    const double along_v = k == 0 ? 0.0 : random.uniform(-0.2, 0.2);
    const glm::dvec3 at_m = centre_m + along_u * u_m + along_v * v_m;
    builder.add_mesh({at_m - size * u_m - size * v_m, at_m + size * u_m - size * v_m,
                      at_m + size * u_m + size * v_m, at_m - size * u_m + size * v_m},
                     {{0, 1, 2}, {0, 2, 3}}, {0.5, k == 0 || random.flip()});
  }
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, ring_about(glm::dvec3(0)));
  check_same_everywhere(engine, fmt::format("faces in one plane, {} m from the origin", reach_m), measured,
                        everywhere_bright);
}

TEST_CASE("diodes on a board shine and those behind it do not") {
  const Engine engine = both_engines();
  Random random(12);
  Sensor sensor = wall_sensor();
  sensor.world_from_camera = random.pose(10.0);
  SceneBuilder builder(sensor.world_from_camera);
  builder.add_wall({wall_m});
  // Beside the lens and turned to the middle of the wall.
  const glm::dvec3 centre_m(0.5, -0.2, 0.1),
      u_m = glm::normalize(glm::dvec3(1.9, 0, 0.5)),
      v_m = glm::normalize(glm::cross(glm::dvec3(-0.5, 0.2, 1.9), u_m));
  builder.add_mesh({centre_m - 0.2 * u_m - 0.2 * v_m, centre_m + 0.2 * u_m - 0.2 * v_m,
                    centre_m + 0.2 * u_m + 0.2 * v_m, centre_m - 0.2 * u_m + 0.2 * v_m},
                   {{0, 1, 2}, {0, 2, 3}}, {0.5, true});
  std::vector<glm::dvec3> diodes_m;
  for (int k = 0; k < 100; ++k) {
    const double along_u_m = random.uniform(-0.15, 0.15), along_v_m = random.uniform(-0.15, 0.15);
    diodes_m.push_back(centre_m + along_u_m * u_m + along_v_m * v_m);
  }
  diodes_m.push_back(centre_m - 0.05 * glm::cross(u_m, v_m)); // behind it
  const Measurement measured = measure_shadows(engine, builder.scene(), sensor, diodes_m);
  const auto [low, high] = std::minmax_element(measured.lit.begin(), measured.lit.end());
  check_within(engine, "100 diodes on a board and one behind it, least lit", 100.0 / 101.0, *low, 1e-6);
  check_within(engine, "100 diodes on a board and one behind it, most lit", 100.0 / 101.0, *high, 1e-6);
}

TEST_CASE("a diode behind the surface does not reach it") {
  const Engine engine = both_engines();
  // Seen from a lens 0.1 m to its left, nearly along the surface.
  SceneBuilder builder;
  builder.add_mesh({{0.1, -5, 0.2}, {0.1, -5, 9}, {0.1, 5, 9}, {0.1, 5, 0.2}}, {{0, 1, 2}, {0, 2, 3}},
                   {1.0, true});
  Sensor sensor = wall_sensor();
  const Measurement measured =
      measure_shadows(engine, builder.scene(), sensor, {{-0.1, 0, 0}, {0.05, 0.1, 0}, {0.2, 0, 0}});
  std::size_t seen = 0;
  double error = 0.0;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    const bool sees = measured.coverage[pixel] > 0;
    seen += sees;
    error = std::max(error, std::abs(measured.lit[pixel] - (sees ? 2.0 / 3.0 : 0.0)));
  }
  CHECK(seen > 100);
  CHECK(seen < sensor.pixel_count());
  check_within(engine, "two diodes of three in front, lit", 0, error, 1e-6);
}

TEST_CASE("without shadows there is no channel lit, and nothing blocks") {
  const Engine engine = both_engines();
  SceneBuilder builder;
  builder.add_wall({wall_m});
  HalfPlane{{0.3, -4, 1}, {0.3, 4, 1}}.add_to(builder);
  const Sensor sensor = wall_sensor();
  const Measurement measured = measure(engine, builder.scene(), sensor, diodes_at(sensor, {{0.5, 0, 0}}),
                                       Backscatter::lambert, {.device = {}, .keep_visibility = true});
  CHECK(measured.lit.empty());
  CHECK(measured.sample_visibility.empty());
  for (const float amplitude : measured.returns[0].amplitude)
    REQUIRE(amplitude > 0);
}
