// Things thinner than samples lie apart, and things behind holes as fine, are seen by the samples whose rays
// meet them, through every lens.

#include "tests/comparison/frame_bytes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/support/thin_things.h"

#include "engine/reference/reference.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <memory>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct BendingLens {
  std::string name;
  Distortion distortion;
  double focal_length_m;
};

const std::array lenses{BendingLens{"barrel", BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01}, 0.02},
                        BendingLens{"pincushion", BrownConrady{0.2, 0, 0, 0, 0}, 0.025},
                        BendingLens{"fisheye", Fisheye{-0.03, 0.01, -0.004, 0.0005}, 0.009},
                        BendingLens{"fisheye beyond 90 degrees", Fisheye{}, 0.006}};

// 160 x 120 samples, as one or as several a pixel.
Sensor sensor_of(const BendingLens &lens, std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = glm::uvec2(160, 120) / samples;
  sensor.pixel_pitch_m = glm::dvec2(24e-3 / sensor.resolution.x);
  sensor.focal_length_m = lens.focal_length_m;
  sensor.distortion = lens.distortion;
  sensor.samples = samples;
  return sensor;
}

// Upright, tilted, and filled in part: rasters of their own for each.
std::vector<Sensor> straight_sensors() {
  std::vector<Sensor> sensors;
  for (const std::uint32_t samples : {1u, 2u})
    for (const double tilt_rad : {0.0, 0.1})
      for (const double fill : {1.0, 0.7}) {
        sensors.push_back(sensor_of({"", {}, 0.02}, samples));
        sensors.back().chip.rotation_rad.x = tilt_rad;
        sensors.back().fill_factor = glm::dvec2(fill);
      }
  return sensors;
}

std::vector<Illuminator> light_in(const Sensor &sensor) {
  return {monostatic_illuminator(sensor.world_from_camera)};
}

Simulator simulator_of(SamplePrecision precision, std::uint32_t max_strip_samples = 0) {
  SimulatorOptions options = keep_everything(max_strip_samples);
  options.precision = precision;
  return make_simulator(options);
}

Measurement measure(Simulator &simulator, const Scene &scene, const Sensor &sensor) {
  simulator.prepare(scene, sensor, light_in(sensor), Backscatter::constant);
  return simulator.measure();
}

// Sees what the reference sees, in both forms of the extended precision.
class Comparer {
public:
  void check(const std::string &name, const Scene &scene, const Sensor &sensor) {
    const std::vector<std::uint32_t> expected =
        reference::simulate(scene, sensor, light_in(sensor), Backscatter::constant).sample_triangle_id;
    const auto things = expected.size() - static_cast<std::size_t>(std::ranges::count(expected, no_id));
    REQUIRE(things > 200);
    for (Simulator &simulator : simulators_) {
      const std::vector<std::uint32_t> seen = measure(simulator, scene, sensor).sample_triangle_id;
      std::size_t differing = 0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        differing += seen[i] != expected[i];
      INFO(fmt::format("{}: {} samples differ, of {} that see something", name, differing, things));
      CHECK(static_cast<double>(differing) <= 1e-3 * static_cast<double>(things));
    }
  }

  // Checks the scene that `scene` makes for each lens and each count of samples.
  template <typename MakeScene>
  void check_all(std::initializer_list<std::uint32_t> samples, const MakeScene &scene) {
    for (const BendingLens &lens : lenses)
      for (const std::uint32_t side : samples) {
        const Sensor sensor = sensor_of(lens, side);
        Random random(side);
        check(fmt::format("{}, S = {}", lens.name, side), scene(random, sensor), sensor);
      }
  }

private:
  std::array<Simulator, 2> simulators_{simulator_of(SamplePrecision::automatic),
                                       simulator_of(SamplePrecision::double_float)};
};

// A wall 2 m off with square holes of 6 mm, a quarter of a sample to a sample wide, and another behind it.
Scene mask_before_a_wall() {
  SceneBuilder builder;
  Paint paint;
  paint.reflectivity_rgb = glm::dvec3(0.3);
  paint.alpha_cutoff = 0.5;
  paint.filter = TextureFilter::nearest;
  auto texture = std::make_shared<Texture>();
  texture->size = {4, 4};
  texture->texels.assign(16, glm::vec4(1.0f));
  texture->texels[5].a = 0.0f;
  paint.texture = texture;
  builder.add_wall({2.0, {0.0, true, paint}, {-1.5, -1.2}, {1.5, 1.2}});
  builder.add_wall({2.5});
  Scene scene = builder.scene();
  for (const glm::dvec3 &position_m : scene.positions_m)
    scene.texture_coordinates.emplace_back(glm::dvec2(position_m) / 0.024);
  return scene;
}

// A ball of 0.4 m radius, 2 m off: hundreds of triangles a sample.
Scene fine_ball() {
  constexpr std::uint32_t around = 400, up = 200;
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t v = 0; v <= up; ++v)
    for (std::uint32_t u = 0; u < around; ++u) {
      const double turn_rad = 2.0 * std::numbers::pi * u / around;
      const double rise_rad = std::numbers::pi * (static_cast<double>(v) / up - 0.5);
      corners_m.push_back(glm::dvec3(0.1, 0.05, 2.0) +
                          0.4 * glm::dvec3(std::cos(rise_rad) * std::sin(turn_rad), std::sin(rise_rad),
                                           std::cos(rise_rad) * std::cos(turn_rad)));
    }
  for (std::uint32_t v = 0; v < up; ++v)
    for (std::uint32_t u = 0; u < around; ++u) {
      const std::uint32_t at = v * around + u, beside = v * around + (u + 1) % around;
      faces.push_back({at, beside, beside + around});
      faces.push_back({at, beside + around, at + around});
    }
  SceneBuilder builder;
  builder.add_mesh(corners_m, faces, {0.5, true});
  return builder.scene();
}

std::vector<Sensor> straight_and_bending() {
  std::vector<Sensor> sensors = straight_sensors();
  for (const BendingLens &lens : lenses)
    sensors.push_back(sensor_of(lens, 2));
  return sensors;
}

void check_bits_in_strips(const std::vector<Sensor> &sensors) {
  Simulator whole = simulator_of(SamplePrecision::automatic);
  for (const Sensor &sensor : sensors) {
    Random random(2);
    const Scene scene = grass(random, 500, sensor);
    const std::string bytes = bytes_of(measure(whole, scene, sensor));
    for (const std::uint32_t rows : {1u, 5u}) {
      Simulator in_strips = simulator_of(SamplePrecision::automatic,
                                         rows * sensor.samples * sensor.samples * sensor.resolution.x);
      CHECK(bytes == bytes_of(measure(in_strips, scene, sensor)));
    }
  }
}

} // namespace

TEST_CASE("rods thinner than the samples lie apart are seen through bending lenses") {
  Comparer().check_all(
      {1, 2, 4}, [](Random &random, const Sensor &sensor) { return rods_in_view(random, 60, 0.4, sensor); });
}

TEST_CASE("lone points are seen through bending lenses") {
  Comparer().check_all({1, 2, 4}, [](Random &random, const Sensor &sensor) {
    return points_in_view(random, 2000, 0.6, sensor);
  });
}

TEST_CASE("points larger than samples have round rims through bending lenses") {
  Comparer().check_all(
      {1}, [](Random &random, const Sensor &sensor) { return points_in_view(random, 300, 9.0, sensor); });
}

TEST_CASE("grass, and the floor between its blades, are seen through bending lenses") {
  Comparer().check_all({2}, [](Random &random, const Sensor &sensor) { return grass(random, 1500, sensor); });
}

TEST_CASE("a wall is seen through holes smaller than samples") {
  Comparer().check_all({1}, [](Random &, const Sensor &) { return mask_before_a_wall(); });
}

TEST_CASE("a fine ball has no holes through bending lenses") {
  Comparer().check_all({1}, [](Random &, const Sensor &) { return fine_ball(); });
}

TEST_CASE("rods and grass without distortion are seen to the width of their edges") {
  Comparer comparer;
  for (const Sensor &sensor : straight_sensors()) {
    const std::string name = fmt::format("S = {}, filled to {}, tilted by {}", sensor.samples,
                                         sensor.fill_factor.x, sensor.chip.rotation_rad.x);
    Random random(sensor.samples);
    comparer.check(name, rods_in_view(random, 60, 0.4, sensor), sensor);
    comparer.check(name, grass(random, 1500, sensor), sensor);
  }
}

TEST_CASE("thin things have the same bits in some strips") {
  check_bits_in_strips(every_third(straight_and_bending()));
}

TEST_CASE("thin things have the same bits in any strips", "[long]") {
  check_bits_in_strips(straight_and_bending());
}
