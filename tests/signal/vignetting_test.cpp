// cos^4 vignetting: how much less pixels off the axis see, by hand.

#include "tests/comparison/engines.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("cos^4 vignetting of pixels at known angles") {
  const Engine engine = both_engines();
  Sensor sensor;
  sensor.resolution = {7, 1};
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = {0.05, 0.001}; // slopes -1.5, -1 ... 1.5
  sensor.vignetting = Vignetting::cos4;
  const Measurement with = measure_monostatic(engine, wall_at(2), sensor);
  sensor.vignetting = Vignetting::none;
  const Measurement without = measure_monostatic(engine, wall_at(2), sensor);
  for (std::size_t pixel = 0; pixel < 7; ++pixel) {
    const double slope = (static_cast<double>(pixel) - 3) * 0.5;
    const double cos2 = 1 / (1 + slope * slope);
    const std::string name = fmt::format("slope {:+}", slope);
    // The wall's return falls with the square of the range, 2 m over the cosine.
    check_amplitude(engine, name + ", without vignetting", cos2 / 4, without.returns[0].amplitude[pixel]);
    check_amplitude(engine, name + ", with cos^4", cos2 * cos2 * cos2 / 4, with.returns[0].amplitude[pixel]);
    check_amplitude(engine, name + ", with over without", cos2 * cos2,
                    double{with.returns[0].amplitude[pixel]} / without.returns[0].amplitude[pixel]);
    CHECK(with.returns[0].distance_m[pixel] == Approx(without.returns[0].distance_m[pixel]).epsilon(3e-7));
  }
}

TEST_CASE("cos^4 vignetting takes the ray's angle, not the place on the chip") {
  const Engine engine = both_engines();
  const double degrees = GENERATE(30.0, 80.0, 100.0);
  const double angle_rad = degrees * std::numbers::pi / 180;
  Sensor sensor = axial_sensor();
  sensor.distortion = Fisheye{};
  sensor.chip.translation_m.x = angle_rad * sensor.focal_length_m;
  sensor.vignetting = Vignetting::cos4;
  SceneBuilder builder;
  builder.add_mesh({{1, -9, -9}, {1, 9, -9}, {1, 9, 9}, {1, -9, 9}}, {{0, 1, 2}, {0, 2, 3}}, {1.0, true});
  const Measurement measured = measure_monostatic(engine, builder.scene(), sensor);
  const double range_m = 1 / std::sin(angle_rad), cosine = std::cos(angle_rad);
  check_within(engine, fmt::format("fisheye at {} degrees, range", degrees), range_m, measured.range_m[0],
               2e-6);
  if (degrees < 90)
    check_amplitude(engine, fmt::format("fisheye at {} degrees, cos^4", degrees),
                    std::pow(cosine, 4) / (range_m * range_m), measured.returns[0].amplitude[0]);
  else
    CHECK(measured.returns[0].amplitude[0] == 0);
  CHECK(std::isnan(measured.returns[0].distance_m[0]) == (degrees > 90));
  CHECK(measured.coverage[0] == 1);
}
