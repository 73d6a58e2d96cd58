// Light within a sphere, which has a closed form for any number of bounces.

#include "tests/multipath/frames.h"
#include "tests/reference/shadow_fixture.h"
#include "tests/support/sphere.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct SphereErrors {
  double distance_m, amplitude; // the largest of all pixels; of the amplitude, over the direct one's
};

SphereErrors sphere_errors(const SphereMesh &mesh, std::uint32_t bounces, double modulation_hz,
                           const Sphere &sphere = {}) {
  Sensor sensor = wide_sensor({6, 6}, 2);
  sensor.modulation_hz = {modulation_hz};
  const Measurement frame =
      bounced_frame(mesh.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                    {.count = bounces, .max_error_m = 1e-3 * 20e6 / modulation_hz});
  const auto expected = return_over_direct(bounces, modulation_hz, sphere);
  const double expected_m =
      sphere.radius_m + sensor.ambiguity_m() * std::arg(expected) / (2.0 * std::numbers::pi);
  const Return &found = frame.returns[0];
  SphereErrors errors{0.0, 0.0};
  for (std::size_t i = 0; i < found.amplitude.size(); ++i) {
    const double direct = static_cast<double>(bounces > 0 ? found.direct_amplitude[i] : found.amplitude[i]);
    errors.distance_m =
        std::max(errors.distance_m, std::abs(static_cast<double>(found.distance_m[i]) - expected_m));
    errors.amplitude =
        std::max(errors.amplitude,
                 std::abs(static_cast<double>(found.amplitude[i]) / direct / std::abs(expected) - 1.0));
  }
  fmt::print("{:>8} triangles, {:>4} bounces, {:>6.3g} MHz: distance off by at most {:.4f} mm, amplitude by "
             "{:.4f} %\n",
             mesh.scene.triangles.size(), bounces == all_bounces ? "all" : fmt::format("{}", bounces),
             modulation_hz / 1e6, 1e3 * errors.distance_m, 100.0 * errors.amplitude);
  return errors;
}

} // namespace

TEST_CASE("the simulator's light bounces within a sphere as its formula says") {
  const SphereMesh mesh = sphere_mesh(5);
  for (const std::uint32_t bounces : {0u, 1u, 2u, all_bounces}) {
    CAPTURE(bounces);
    const SphereErrors errors = sphere_errors(mesh, bounces, 20e6);
    CHECK(errors.distance_m < 1e-3 + 2.0 * mesh.error_m);
    CHECK(errors.amplitude < 1e-3 + 2.0 * mesh.error_m / sphere_radius_m);
  }
}

TEST_CASE("the simulator's slow light within a sphere adds up to 1 / (1 - rho) of its direct part") {
  const SphereMesh mesh = sphere_mesh(5);
  const SphereErrors errors = sphere_errors(mesh, all_bounces, 1e3);
  CHECK(errors.amplitude < 1e-3 + 4.0 * mesh.error_m / sphere_radius_m);
}

TEST_CASE("the mean light bounces, too, without a phase and by the depth of its modulation") {
  const SphereMesh mesh = sphere_mesh(5);
  Sensor sensor = wide_sensor({6, 6}, 2);
  sensor.modulation_hz = {1e3}; // so slow that the return is the mean of the modulated part
  sensor.electronics.emplace();
  Illuminator light = monostatic_illuminator(sensor.world_from_camera);
  light.modulation_depth = 0.8;
  light.modulation_phase_rad = 0.5;
  const Measurement frame =
      bounced_frame(mesh.scene, sensor, {light}, {.count = all_bounces, .max_error_m = 1e-3 * 20e6 / 1e3});
  REQUIRE(frame.mean_radiance.size() == frame.coverage.size());
  for (std::size_t i = 0; i < frame.mean_radiance.size(); ++i)
    CHECK(frame.mean_radiance[i] == Approx(frame.returns[0].amplitude[i] / 0.8).epsilon(2e-3));
}

TEST_CASE("within spheres of 20480 triangles distances are right to 1 mm and amplitudes to 0.1 %", "[long]") {
  const auto check = [](const Sphere &sphere, std::uint32_t bounces, double modulation_hz) {
    const SphereMesh mesh = sphere_mesh(5, sphere, icosahedron());
    CHECK(mesh.scene.triangles.size() == 20'480);
    return sphere_errors(mesh, bounces, modulation_hz, sphere);
  };
  for (const auto &[sphere, modulation_hz] : {std::pair(Sphere{}, 20e6), {Sphere{0.7, 0.5}, 60e6}})
    for (const std::uint32_t bounces : {0u, 1u, 2u, all_bounces}) {
      const SphereErrors errors = check(sphere, bounces, modulation_hz);
      CHECK(errors.distance_m < 1e-3);
      CHECK(errors.amplitude < 1e-3);
    }
  CHECK(check({}, all_bounces, 1e3).amplitude < 1e-3);
}

TEST_CASE("within a fine sphere distances are right to 1 mm and amplitudes to 0.1 %", "[long]") {
  double before_m = 1.0;
  for (const int divisions : {4, 5, 6}) { // 2,048, 8,192 and 32,768 triangles
    const SphereMesh mesh = sphere_mesh(divisions);
    double worst_m = 0.0, worst = 0.0;
    for (const std::uint32_t bounces : {0u, 1u, 2u, all_bounces}) {
      const SphereErrors errors = sphere_errors(mesh, bounces, 20e6);
      worst_m = std::max(worst_m, errors.distance_m);
      worst = std::max(worst, errors.amplitude);
    }
    CHECK(worst_m < before_m);
    before_m = worst_m;
    if (divisions == 6) {
      CHECK(worst_m < 1e-3);
      CHECK(worst < 1e-3);
    }
  }
}
