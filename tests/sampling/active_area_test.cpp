// A pixel's view through its active area, by the places of its samples.

#include "tests/comparison/planes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// On a wall at 1 m a pixel takes 100 x 100 mm; the middle one has its centre on the axis.
Sensor three_by_three_sensor(const glm::dvec2 &fill_factor, std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {3, 3};
  sensor.pixel_pitch_m = glm::dvec2(0.01);
  sensor.focal_length_m = 0.1;
  sensor.fill_factor = fill_factor;
  sensor.samples = samples;
  return sensor;
}
constexpr std::size_t middle = 4;

Measurement measure_wall(Engine engine, const Sensor &sensor, const glm::dvec2 &lower_m,
                         const glm::dvec2 &upper_m) {
  SceneBuilder builder;
  builder.add_wall({1, {}, lower_m, upper_m});
  return measure_monostatic(engine, builder.scene(), sensor);
}

} // namespace

TEST_CASE("an edge outside the active area is not seen, within it it is") {
  const Engine engine = both_engines();
  // Samples of four in a row at -37.5, -12.5, 12.5 and 37.5 mm, of half the width at half of that.
  const auto [fill, edge_m, coverage] = GENERATE(table<double, double, double>(
      {{1.0, -0.03, 0.75}, {0.5, -0.03, 1.0}, {1.0, 0.03, 0.25}, {0.5, 0.03, 0.0}}));
  const bool along_x = GENERATE(true, false);
  const glm::dvec2 fill_factor = along_x ? glm::dvec2(fill, 1) : glm::dvec2(1, fill);
  const glm::dvec2 lower_m = along_x ? glm::dvec2(edge_m, -1) : glm::dvec2(-1, edge_m);
  const Sensor sensor = three_by_three_sensor(fill_factor, 4);
  const Measurement measured = measure_wall(engine, sensor, lower_m, {1, 1});
  check_within(engine,
               fmt::format("fill {} in {}, edge {:+} mm, coverage", fill, along_x ? 'x' : 'y', 1e3 * edge_m),
               coverage, measured.coverage[middle], 0);
  CHECK(measured.coverage[along_x ? 5 : 7] == 1);
  CHECK(measured.coverage[along_x ? 3 : 1] == 0);
  CHECK(std::isnan(measured.returns[0].distance_m[middle]) == (coverage == 0));
}

TEST_CASE("the coverage of an active area, counted by hand") {
  const Engine engine = both_engines();
  // Samples at -20, 0 and 20 mm across, -13.3, 0 and 13.3 mm down: the wall fills the first two columns and
  // the last two rows of them. If the whole pixel were active, with samples at -33, 0 and 33 mm, it would
  // fill the middle one only.
  const Sensor sensor = three_by_three_sensor({0.6, 0.4}, 3);
  const Measurement measured = measure_wall(engine, sensor, {-0.025, -0.01}, {0.015, 0.02});
  for (std::size_t pixel = 0; pixel < 9; ++pixel)
    check_within(engine, fmt::format("3 x 3 samples, pixel {}, coverage", pixel),
                 pixel == middle ? 4.0 / 9 : 0, measured.coverage[pixel], 1e-7);
  // 100 mm further left and down, where the lower left pixel looks.
  const Measurement beside = measure_wall(engine, sensor, {-0.125, 0.09}, {-0.085, 0.12});
  for (std::size_t pixel = 0; pixel < 9; ++pixel)
    check_within(engine, fmt::format("3 x 3 samples, wall at the lower left, pixel {}, coverage", pixel),
                 pixel == 6 ? 4.0 / 9 : 0, beside.coverage[pixel], 1e-7);
}

TEST_CASE("the places of 2 x 2 samples in an active area of 0.6 x 0.4") {
  const Engine engine = both_engines();
  const Sensor sensor = three_by_three_sensor({0.6, 0.4}, 2);
  // 15 mm from the centre to the sides, 10 mm up and down; small walls there are hit, 2 mm beside not.
  const glm::dvec2 half_m(1e-3);
  for (const double x_m : {-0.015, 0.015})
    for (const double y_m : {-0.010, 0.010})
      for (const double beside_m : {0.0, 2e-3}) {
        const glm::dvec2 centre_m(x_m + beside_m, y_m);
        const Measurement measured = measure_wall(engine, sensor, centre_m - half_m, centre_m + half_m);
        check_within(engine,
                     fmt::format("small wall at {:.0f}, {:.0f} mm, coverage", 1e3 * centre_m.x, 1e3 * y_m),
                     beside_m == 0 ? 0.25 : 0, measured.coverage[middle], 0);
        // The sample nearest the centre is the upper left one.
        CHECK((measured.triangle_id[middle] != no_id) == (x_m < 0 && y_m < 0 && beside_m == 0));
      }
}

TEST_CASE("an active area mixes the returns of its samples") {
  const Engine engine = both_engines();
  Sensor sensor = three_by_three_sensor({0.6, 0.4}, 2);
  sensor.modulation_hz = {300e6};
  const Square square{{0, 0, 1}, {1.0, 0.7, -1.0}};
  const Measurement measured = measure_monostatic(engine, scene_of(square), sensor);
  // The pixel to the right of the middle one, in millimetres on the chip.
  double range_sum_m = 0, z_sum_m = 0;
  std::complex<double> z = 0;
  for (const double x_mm : {8.5, 11.5})
    for (const double y_mm : {-1.0, 1.0}) {
      const glm::dvec3 point_m = meeting_point_m(square, {x_mm, y_mm, 100});
      const double range_m = glm::length(point_m);
      range_sum_m += range_m;
      z_sum_m += point_m.z;
      z += std::polar(0.25 / (range_m * range_m), 2 * std::numbers::pi * range_m / sensor.ambiguity_m());
    }
  check_within(engine, "2 x 2 samples of a slanted wall, range", range_sum_m / 4, measured.range_m[5], 2e-6);
  check_within(engine, "2 x 2 samples of a slanted wall, z", z_sum_m / 4, measured.z_m[5], 2e-6);
  check_amplitude(engine, "2 x 2 samples of a slanted wall, amplitude", std::abs(z),
                  measured.returns[0].amplitude[5]);
  const double turns = std::arg(z) / (2 * std::numbers::pi);
  check_distance(engine, "2 x 2 samples of a slanted wall, distance",
                 (turns < 0 ? turns + 1 : turns) * sensor.ambiguity_m(), sensor,
                 measured.returns[0].distance_m[5]);
}
