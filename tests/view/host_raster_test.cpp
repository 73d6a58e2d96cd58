// The host's raster leaves the bits of the device's.

#include "tests/comparison/frame_bytes.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/support/units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <initializer_list>
#include <string>
#include <utility>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Sensor drawing_sensor(std::uint32_t samples, const glm::dvec2 &fill_factor, const glm::dvec3 &rotation_rad) {
  Sensor sensor;
  sensor.resolution = {97, 83};
  sensor.pixel_pitch_m = {1.1e-4, 1.3e-4};
  sensor.focal_length_m = 0.005;
  sensor.samples = samples;
  sensor.fill_factor = fill_factor;
  sensor.chip.rotation_rad = rotation_rad;
  return sensor;
}

// From parts of a sample to most of the frame, with common edges, corners behind the lens, and intersections.
Scene scene_of_all_sizes(std::uint32_t seed, const Sensor &sensor) {
  Random random(seed);
  Scene scene = random_triangles(random, 300, sensor.world_from_camera);
  for (std::size_t i = 0; i < 20000; ++i) {
    const double size_m = random.log_uniform(1e-3, 0.3);
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    const glm::dvec3 place_m = random.in_box({-1.2, -1.2, 0.8}, {1.2, 1.2, 3.0});
    for (int k = 0; k < 4; ++k)
      scene.positions_m.push_back(sensor.world_from_camera.point(place_m + size_m * random.unit_vector()));
    for (std::uint32_t k = 0; k < 2; ++k) {
      Triangle triangle = scene.triangles.front();
      triangle.vertices = {first + k, first + 1 + k, first + 2 + k};
      scene.triangles.push_back(triangle);
    }
  }
  return scene;
}

std::string drawn(const Scene &scene, const Sensor &sensor, bool on_host, std::uint32_t host_vector_bits,
                  std::uint32_t max_strip_samples) {
  SimulatorOptions options = keep_everything(max_strip_samples);
  options.host_vector_bits = host_vector_bits;
  options.allowed.host_raster = on_host;
  options.allowed.host_sum = false; // whose last digits depend on whether vectors fuse
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, {light_at(ring(24, 0.1), 0.0)}, Backscatter::constant);
  const auto path = simulator.path();
  const auto raster = std::ranges::find(path, "raster", &std::pair<std::string, std::string>::first);
  REQUIRE(raster != path.end());
  CHECK(raster->second == (on_host ? "host" : "device"));
  return bytes_of(simulator.measure());
}

struct Drawing {
  std::uint32_t host_vector_bits, strip_rows; // 0: the whole frame
};

void check_alike(std::uint32_t samples, const glm::dvec2 &fill_factor, const glm::dvec3 &rotation_rad,
                 std::initializer_list<Drawing> drawings) {
  const Sensor sensor = drawing_sensor(samples, fill_factor, rotation_rad);
  const Scene scene = scene_of_all_sizes(samples, sensor);
  const std::string expected = drawn(scene, sensor, false, 512, 0);
  for (const auto &[host_vector_bits, strip_rows] : drawings) {
    INFO(fmt::format("S = {}, fill {} x {}, tilted {}, {} bits, strips of {} rows", samples, fill_factor.x,
                     fill_factor.y, rotation_rad != glm::dvec3(0), host_vector_bits, strip_rows));
    const std::uint32_t max_strip_samples = strip_rows * sensor.resolution.x * samples * samples;
    CHECK((drawn(scene, sensor, true, host_vector_bits, max_strip_samples) == expected));
  }
}

const glm::dvec3 tilted_rad = glm::dvec3(9, -7, 20) * degree;

} // namespace

TEST_CASE("the host draws what the device draws, in vectors of any width and strips of any height") {
  check_alike(1, {0.6, 0.4}, tilted_rad, {{512, 7}, {256, 0}, {128, 7}});
  check_alike(3, {1, 1}, {0, 0, 0}, {{512, 0}, {256, 7}, {128, 0}});
}

TEST_CASE("the host draws what the device draws, other samples and chips", "[long]") {
  const glm::dvec3 rotation_rad = GENERATE(glm::dvec3(0), tilted_rad);
  const auto check = [&](std::uint32_t samples, const glm::dvec2 &fill_factor) {
    check_alike(samples, fill_factor, rotation_rad,
                {{512, 0}, {256, 0}, {128, 0}, {512, 7}, {256, 7}, {128, 7}});
  };
  check(1, {1, 1});
  check(1, {0.6, 0.4});
  check(3, {1, 1}); // several samples of pixels that are filled in part are the device's
}

TEST_CASE("which of two faces in one plane the host draws does not depend on where strips end") {
  // Their depths differ by rounding alone.
  SceneBuilder faces;
  for (const double half_m : {3.0, 0.67}) {
    const auto corner = [&](double x, double y) {
      return glm::dvec3(x * half_m, y * half_m, 2.0 + 0.3 * x * half_m + 0.03 * y * half_m);
    };
    faces.add_mesh({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, {{0, 2, 1}, {0, 3, 2}});
  }
  const Sensor sensor = drawing_sensor(2, {1, 1}, {0, 0, 0});
  const Scene scene = faces.scene();
  const std::string whole = drawn(scene, sensor, true, 512, 0);
  for (const std::uint32_t rows : {1u, 7u, 20u}) {
    INFO("strips of " << rows << " rows");
    CHECK((drawn(scene, sensor, true, 512, rows * sensor.resolution.x * 4) == whole));
  }
}
