// Which surfaces light bounces off, and which it passes.

#include "tests/reference/bounce_fixture.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// z of one bounce to a wall before the lens from a wall behind it, and from `screen` between.
std::complex<double> bounced_past(const std::vector<Plate> &screens, Shadows shadows = Shadows::automatic) {
  std::vector<Plate> plates = parallel_plates();
  plates.insert(plates.end(), screens.begin(), screens.end());
  const Sensor sensor = axial_sensor();
  reference::Options options = bouncing(1, 4096);
  options.shadows = shadows;
  const auto frame =
      frame_of(scene_of(plates), sensor, {diode_beside_lens(sensor, diode_at({0.2, 0.1, 0.3}))}, options);
  return indirect_z(frame.returns[0], 0);
}

// Hides the wall behind, its front towards the lens or away from it.
Plate screen_behind(bool front_to_lens, const Surface &surface) {
  const glm::dvec3 across(2, 0, 0), down(0, 2, 0);
  return {{-1, -1, -0.3}, front_to_lens ? across : down, front_to_lens ? down : across, surface};
}

Paint mask_of(double alpha) {
  Paint paint;
  paint.alpha = alpha;
  paint.alpha_cutoff = 0.5;
  return paint;
}

} // namespace

TEST_CASE("the back of a single-sided triangle blocks what bounces, and reflects nothing") {
  CHECK(std::abs(bounced_past({})) > 1e-3);
  CHECK(bounced_past({screen_behind(false, {0.5})}) == 0.0);
}

TEST_CASE("both sides of a double-sided triangle reflect") {
  const auto front = bounced_past({screen_behind(true, {0.5})});
  CHECK(std::abs(front) > 1e-3);
  CHECK(std::abs(bounced_past({screen_behind(true, {0.5, true})}) - front) < 1e-9 * std::abs(front));
  // Seen from its back it has other corners in the same places.
  CHECK(std::abs(bounced_past({screen_behind(false, {0.5, true})}) - front) < 1e-5 * std::abs(front));
}

TEST_CASE("what bounces passes where a mask leaves the surface out") {
  const auto free = bounced_past({});
  CHECK(std::abs(bounced_past({screen_behind(true, {0.5, false, mask_of(0.4)})}) - free) <
        1e-5 * std::abs(free));
  const auto screened = bounced_past({screen_behind(true, {0.5})});
  const auto there = bounced_past({screen_behind(true, {0.5, false, mask_of(0.6)})});
  CHECK(std::abs(there - screened) < 1e-9 * std::abs(screened));
  CHECK(std::abs(free - screened) > 1e-2 * std::abs(free));
}

TEST_CASE("half a mask is half a screen") {
  Paint paint = mask_of(1.0);
  paint.texture =
      std::make_shared<const Texture>(Texture{{2, 1}, {glm::vec4(1, 1, 1, 0), glm::vec4(1, 1, 1, 1)}});
  paint.filter = TextureFilter::nearest;
  std::vector<Plate> plates = parallel_plates();
  plates.push_back(screen_behind(false, {0.5, false, paint}));
  Scene masked = scene_of(plates);
  masked.texture_coordinates.resize(masked.positions_m.size());
  const std::size_t first = masked.positions_m.size() - 4;
  // v runs along the screen's sides of y, u along those of x.
  masked.texture_coordinates[first] = {0, 0}, masked.texture_coordinates[first + 1] = {0, 1};
  masked.texture_coordinates[first + 2] = {1, 1}, masked.texture_coordinates[first + 3] = {1, 0};
  plates.back() = {{0, -1, -0.3}, {0, 2, 0}, {1, 0, 0}, {0.5}};

  const Sensor sensor = axial_sensor();
  const Illuminator light = diode_beside_lens(sensor, diode_at({0.2, 0.1, 0.3}));
  const auto expected = frame_of(scene_of(plates), sensor, {light}, bouncing(1, 4096));
  const auto found = frame_of(masked, sensor, {light}, bouncing(1, 4096));
  CHECK(std::abs(indirect_z(found.returns[0], 0) - indirect_z(expected.returns[0], 0)) <
        1e-5 * std::abs(indirect_z(expected.returns[0], 0)));
}

TEST_CASE("paint counts where light bounces off it") {
  const auto white = bounced_past({});
  std::vector<Plate> plates = parallel_plates();
  Paint paint;
  paint.reflectivity_rgb = {0.25, 0, 0};
  plates[1].surface = {0.0, false, paint}; // half of the 0.5 that it was
  const Sensor sensor = axial_sensor();
  const auto frame = frame_of(scene_of(plates), sensor,
                              {diode_beside_lens(sensor, diode_at({0.2, 0.1, 0.3}))}, bouncing(1, 4096));
  CHECK(std::abs(indirect_z(frame.returns[0], 0) - 0.5 * white) < 1e-9 * std::abs(white));
}

TEST_CASE("without shadows diodes light what is hidden from them, but light bounces along free ways only") {
  // Black, before the diode, to the side of every way between the walls that counts.
  const Plate lid{{0.1, 0.0, 0.25}, {0.2, 0, 0}, {0, 0.2, 0}, {0.0, true}};
  const auto free = bounced_past({}), unlit = bounced_past({lid}), lit = bounced_past({lid}, Shadows::off);
  CHECK(std::abs(unlit) < 0.7 * std::abs(free));
  CHECK(std::abs(lit - free) < 0.2 * std::abs(free));
  CHECK(bounced_past({screen_behind(false, {0.5})}, Shadows::off) == 0.0);
}

TEST_CASE("all that a surface reflects goes on, and paths still end") {
  const std::vector<Plate> plates = parallel_plates();
  std::vector<Plate> white = plates;
  for (Plate &plate : white)
    plate.surface.reflectivity = 1.0;
  const Sensor sensor = axial_sensor();
  const Illuminator light = diode_beside_lens(sensor, diode_at({0.2, 0.1, 0.3}));
  const auto all = frame_of(scene_of(white), sensor, {light}, bouncing(all_bounces, 4096));
  const auto most = frame_of(scene_of(white), sensor, {light}, bouncing(40, 4096));
  CHECK(std::abs(all.returns[0].z[0] - most.returns[0].z[0]) <
        4 * std::hypot(all.returns[0].z_error[0], most.returns[0].z_error[0]));
}

TEST_CASE("light bounces by a Lambertian backscatter only") {
  const Sensor sensor = axial_sensor();
  CHECK_THROWS_AS(reference::simulate(wall_at(1), sensor, {monostatic_illuminator(sensor.world_from_camera)},
                                      Backscatter::constant, bouncing(1, 16)),
                  std::logic_error);
}
