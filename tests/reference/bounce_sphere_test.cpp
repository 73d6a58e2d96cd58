// Light within a sphere, which has a closed form for any number of bounces: from any point of it every part
// of the sphere takes the same share of the light.

#include "tests/reference/bounce_fixture.h"
#include "tests/support/sphere.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

reference::Frame sphere_frame(const SphereMesh &mesh, Sensor sensor, double modulation_hz,
                              const reference::Options &options) {
  sensor.modulation_hz = {modulation_hz};
  return frame_of(mesh.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)}, options);
}

void check_sphere(const SphereMesh &mesh, std::uint32_t bounces, std::uint32_t paths) {
  const Sensor sensor = wide_sensor({2, 2}, 2);
  const auto frame = sphere_frame(mesh, sensor, 20e6, bouncing(bounces, paths));
  const reference::FrameReturn &found = frame.returns[0];
  const auto expected = return_over_direct(bounces, 20e6);
  const double expected_m = sphere_radius_m + sensor.ambiguity_m() * std::arg(expected) / full_turn_rad;
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    CAPTURE(bounces, pixel, found.multipath_error_m[pixel], mesh.error_m);
    CHECK(std::abs(found.direct_distance_m[pixel] - sphere_radius_m) < mesh.error_m + 1e-9);
    // A facet moves the direct distance by its depth, and every flight by no more than twice that.
    CHECK(std::abs(found.distance_m[pixel] - expected_m) <
          4 * found.multipath_error_m[pixel] + 2 * mesh.error_m);
    // Light grows by twice the share of the radius that a facet comes nearer, its own and where it came from.
    const double direct = found.direct_amplitude[pixel];
    CHECK(std::abs(found.amplitude[pixel] / direct - std::abs(expected)) <
          4 * found.z_error[pixel] / direct + 4 * mesh.error_m / sphere_radius_m);
    CHECK(found.indirect_share[pixel] == Approx(std::abs(expected - 1.0) / std::abs(expected))
                                             .margin(4 * found.z_error[pixel] / direct + 1e-3));
  }
}

} // namespace

TEST_CASE("the sphere's formula gives the distances and amplitudes that are known of it") {
  const auto [bounces, distance_m, amplitude] = GENERATE(table<std::uint32_t, double, double>(
      {{0, 2.0000, 1.0}, {1, 2.5581, 1.4785}, {2, 3.0036, 1.4662}, {all_bounces, 2.9248, 1.0497}}));
  const auto expected = return_over_direct(bounces, 20e6);
  CHECK(sphere_radius_m + std::arg(expected) / (2 * wavenumber_20mhz_rad_m) ==
        Approx(distance_m).epsilon(0).margin(5e-5));
  CHECK(std::abs(expected) == Approx(amplitude).epsilon(0).margin(5e-5));
}

TEST_CASE("light bounces within a sphere as its formula says") {
  const SphereMesh mesh = sphere_mesh(6);
  for (const std::uint32_t bounces : {1u, 2u, all_bounces})
    check_sphere(mesh, bounces, 1 << 14);
}

TEST_CASE("light bounces within a fine sphere as its formula says", "[long]") {
  const SphereMesh mesh = sphere_mesh(7);
  for (const std::uint32_t bounces : {1u, 2u, 3u, all_bounces})
    check_sphere(mesh, bounces, 1 << 18);
}

TEST_CASE("slow light within a sphere adds up to 1 / (1 - rho) of its direct part") {
  const SphereMesh mesh = sphere_mesh(5);
  const auto frame = sphere_frame(mesh, axial_sensor(), 1e3, bouncing(all_bounces, 1 << 14));
  const reference::FrameReturn &found = frame.returns[0];
  CHECK(std::abs(return_over_direct(all_bounces, 1e3)) ==
        Approx(1 / (1 - sphere_reflectivity)).epsilon(1e-4));
  const double direct = found.direct_amplitude[0];
  CHECK(found.z_error[0] < 0.02 * found.amplitude[0]);
  CHECK(std::abs(found.amplitude[0] / direct - 1 / (1 - sphere_reflectivity)) <
        4 * found.z_error[0] / direct + 0.01);
}

TEST_CASE("standard errors are as large as errors are, for all bounces") {
  const Sensor sensor = wide_sensor({20, 20}, 2);
  const auto frame = sphere_frame(sphere_mesh(6), sensor, 20e6, bouncing(all_bounces, 256));
  const reference::FrameReturn &found = frame.returns[0];
  const double expected_m =
      sensor.ambiguity_m() * std::arg(return_over_direct(all_bounces, 20e6)) / full_turn_rad;
  int within_two = 0;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < 400; ++pixel) {
    const double errors = (found.multipath_m[pixel] - expected_m) / found.multipath_error_m[pixel];
    within_two += std::abs(errors) < 2;
    squares += errors * errors / 400;
  }
  // Of Student's distribution with 15 degrees of freedom 93.6 % lie within 2, +- 1.2 % for 400 pixels.
  CHECK(within_two > 0.89 * 400);
  CHECK(within_two < 0.98 * 400);
  CHECK(squares == Approx(15.0 / 13.0).epsilon(0.3));
}
