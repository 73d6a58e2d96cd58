// The systematic phase error of square light on few taps ("wiggling") over a whole ambiguity range, and that
// a sine has none.

#include "tests/comparison/planes.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// 6000 pixels in a row that look to both sides by up to 0.5.
Sensor row_sensor() {
  Sensor sensor;
  sensor.resolution = {6000, 1};
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(0.1 / 6000);
  return sensor;
}

// So slanted that its distances go from 10 to 18 m, more than c / (2 f) = 7.49 m at 20 MHz.
const Square slanted_wall{{0, 0, 12.5}, {0.56, 0, -1}, 40};

double range_m(const Sensor &sensor, std::size_t pixel) {
  const double column = static_cast<double>(pixel) + 0.5 - 0.5 * sensor.resolution.x;
  const glm::dvec3 place_m(column * sensor.pixel_pitch_m.x, 0, sensor.focal_length_m);
  return glm::length(meeting_point_m(slanted_wall, place_m));
}

struct PhaseError {
  double lowest_rad = 0, highest_rad = 0;
  double range_swept_m = 0;

  double largest_rad() const { return std::max(-lowest_rad, highest_rad); }
};

PhaseError phase_error(Engine engine, const Sensor &sensor) {
  const Measurement measured = measure_monostatic(engine, scene_of(slanted_wall), sensor);
  PhaseError error;
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    const double true_rad = full_turn_rad * range_m(sensor, pixel) / sensor.ambiguity_m();
    const double error_rad = std::remainder(measured.returns[0].phase_rad[pixel] - true_rad, full_turn_rad);
    REQUIRE(std::isfinite(error_rad));
    error.lowest_rad = std::min(error.lowest_rad, error_rad);
    error.highest_rad = std::max(error.highest_rad, error_rad);
  }
  error.range_swept_m = range_m(sensor, sensor.pixel_count() - 1) - range_m(sensor, 0);
  return error;
}

} // namespace

TEST_CASE("square light wiggles by what its taps alias") {
  const Engine engine = both_engines();
  Sensor sensor = row_sensor();
  sensor.waveform.kind = Waveform::Kind::square;
  const std::vector<std::pair<std::uint32_t, double>> largest_degrees{
      {3, 1.1170}, {4, 4.0746}, {5, 0.2325}, {6, 1.1170}, {8, 0.4594}};
  for (const auto &[taps, expected_degrees] : largest_degrees) {
    sensor.taps = taps;
    const PhaseError error = phase_error(engine, sensor);
    CHECK(error.range_swept_m > sensor.ambiguity_m());
    check_within(engine, fmt::format("square, {} taps, largest phase error, degrees", taps), expected_degrees,
                 error.largest_rad() / degree, 0.001);
    // As far to either side.
    check_within(engine, fmt::format("square, {} taps, lowest phase error, degrees", taps), -expected_degrees,
                 error.lowest_rad / degree, 0.001);
    check_within(engine, fmt::format("square, {} taps, highest phase error, degrees", taps), expected_degrees,
                 error.highest_rad / degree, 0.001);
    if (taps == 4)
      check_within(engine, "square, 4 taps at 20 MHz, mm", 84.83,
                   1e3 * error.largest_rad() / full_turn_rad * sensor.ambiguity_m(), 0.02);
  }
}

TEST_CASE("a sine does not wiggle") {
  const Engine engine = both_engines();
  Sensor sensor = row_sensor();
  for (const std::uint32_t taps : {3u, 4u, 5u, 8u})
    for (const auto kind : {Waveform::Kind::sine, Waveform::Kind::harmonics}) {
      sensor.taps = taps;
      sensor.waveform = {kind, {1.0}};
      const PhaseError error = phase_error(engine, sensor);
      check_within(engine,
                   fmt::format("{}, {} taps, largest phase error, rad",
                               kind == Waveform::Kind::sine ? "sine" : "one harmonic", taps),
                   0, error.largest_rad(), 1e-6);
    }
}
