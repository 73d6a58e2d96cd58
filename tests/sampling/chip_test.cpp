// Where the pixels of a chip look that is tilted, off the axis or focused near: the paper's eq. 1 and the
// thin lens, by hand.

#include "tests/comparison/planes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Slanted, so that no two directions with other signs or swapped axes have the same range.
const Square slanted{{0.1, -0.2, 2.0}, {0.3, 0.5, -1.0}};

// Pixels at (x', y') = (-+26, -+39) mm, 100 mm behind the lens.
Sensor two_by_two_sensor() {
  Sensor sensor;
  sensor.resolution = {2, 2};
  sensor.pixel_pitch_m = {0.052, 0.078};
  sensor.focal_length_m = 0.1;
  return sensor;
}

// `places` are those of the pixels, seen in front of the lens, of any length.
void check_pixels(const std::string &name, const Sensor &sensor, const std::vector<glm::dvec3> &places) {
  const Engine engine = both_engines();
  for (const Square &square : {Square{{0, 0, 2}, {0, 0, 1}}, slanted}) {
    const Measurement measured = measure_monostatic(engine, scene_of(square), sensor);
    for (std::size_t pixel = 0; pixel < places.size(); ++pixel)
      check_point(engine,
                  fmt::format("{}{}, pixel {}", name, square.normal.x == 0 ? "" : ", slanted wall", pixel),
                  meeting_point_m(square, places[pixel]), sensor, measured, pixel);
  }
}

} // namespace

TEST_CASE("a chip inclined about x") {
  Sensor sensor = two_by_two_sensor();
  sensor.chip.rotation_rad.x = std::atan2(3, 4);
  // (x', 0.8 y', 100 + 0.6 y'), mm.
  check_pixels("inclined about x", sensor,
               {{-26, -31.2, 76.6}, {26, -31.2, 76.6}, {-26, 31.2, 123.4}, {26, 31.2, 123.4}});
}

TEST_CASE("a chip inclined about y") {
  Sensor sensor = two_by_two_sensor();
  sensor.chip.rotation_rad.y = std::atan2(7, 24);
  // (0.96 x', y', 100 - 0.28 x'), mm.
  check_pixels("inclined about y", sensor,
               {{-24.96, -39, 107.28}, {24.96, -39, 92.72}, {-24.96, 39, 107.28}, {24.96, 39, 92.72}});
}

TEST_CASE("a chip rotated about the optical axis") {
  Sensor sensor = two_by_two_sensor();
  sensor.chip.rotation_rad.z = std::atan2(5, 12);
  // ((12 x' - 5 y') / 13, (5 x' + 12 y') / 13, 100), mm.
  check_pixels("rotated about z", sensor, {{-9, -46, 100}, {39, -26, 100}, {-39, 26, 100}, {9, 46, 100}});
}

TEST_CASE("a chip tilted about all axes and off the axis") {
  Sensor sensor = two_by_two_sensor();
  sensor.chip.rotation_rad = {std::atan2(3, 4), std::atan2(7, 24), std::atan2(5, 12)};
  sensor.chip.translation_m = {1e-3, -2e-3, 3e-3};
  // D3 gives (9, 46, 0) of the last pixel, D2 of that (8.64, 46, -2.52), D1 (8.64, 38.312, 25.584); t adds
  // (1, -2, 103). D3 gives (39, -26, 0) of the second, D2 (37.44, -26, -10.92), D1 (37.44, -14.248, -24.336).
  check_pixels("tilted about all axes", sensor,
               {{-7.64, -40.312, 77.416},
                {38.44, -16.248, 78.664},
                {-36.44, 12.248, 127.336},
                {9.64, 36.312, 128.584}});
}

TEST_CASE("a lens focused near, chip off the axis, pixels wider than high") {
  Sensor sensor;
  sensor.resolution = {3, 2};
  sensor.pixel_pitch_m = {0.03, 0.02};
  sensor.focal_length_m = 0.1;
  sensor.focus_distance_m = 0.6; // 1/S2 = 10 - 1/0.6: S2 = 120 mm
  sensor.chip.translation_m = {5e-3, -7e-3, 3e-3};
  CHECK(sensor.image_distance_m() == Approx(0.12).epsilon(1e-15));
  check_pixels("focused at 0.6 m, off the axis", sensor,
               {{-25, -17, 123}, {5, -17, 123}, {35, -17, 123}, {-25, 3, 123}, {5, 3, 123}, {35, 3, 123}});
}
