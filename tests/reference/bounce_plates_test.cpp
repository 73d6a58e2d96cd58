// One bounce between plates, against an integral over the plates.

#include "tests/reference/bounce_fixture.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const std::vector<Diode> diodes_of_plates{diode_at({0.2, 0.1, 0.3}), diode_at({-0.1, -0.15, 0.02})};

Illuminator light_of_plates(const Sensor &sensor) {
  return {"diodes", sensor.world_from_camera, diodes_of_plates};
}

// Of each pixel, as frames of single pixels are in the order of Options::pixels.
void check_one_bounce(const std::vector<Plate> &plates, const std::vector<std::uint32_t> &pixels,
                      std::uint32_t paths) {
  const Sensor sensor = wide_sensor({64, 64}, 1.2);
  const Scene scene = scene_of(plates);
  const Illuminator light = light_of_plates(sensor);
  const auto whole = frame_of(scene, sensor, {light});
  const auto frame = frame_of(scene, sensor, {light}, bouncing(1, paths, pixels));
  const reference::FrameReturn &found = frame.returns[0];
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto expected = one_bounce_of(plates, sensor, whole, pixels[i], diodes_of_plates, 150);
    CAPTURE(pixels[i], expected, indirect_z(found, i), found.z_error[i]);
    CHECK(found.direct_z[i] == whole.returns[0].z[pixels[i]]);
    CHECK(std::abs(expected) > 0.01 * std::abs(found.direct_z[i]));
    CHECK(found.z_error[i] < 0.02 * std::abs(expected));
    CHECK(std::abs(indirect_z(found, i) - expected) < 4 * found.z_error[i]);
    CHECK(std::abs(found.multipath_m[i] -
                   multipath_of_m(found.direct_z[i] + expected, found.direct_z[i], sensor.ambiguity_m())) <
          4 * found.multipath_error_m[i]);
  }
}

constexpr std::uint32_t pixel_at(std::uint32_t column, std::uint32_t row) { return row * 64 + column; }

} // namespace

TEST_CASE("one bounce between parallel plates is the integral over the other plate") {
  check_one_bounce(parallel_plates(), {pixel_at(31, 31), pixel_at(3, 60)}, 1 << 14);
}

TEST_CASE("one bounce in a corner is the integral over the other plate") {
  // On the floor and the wall, the last two of either next to the crease, which lies at row 45.3.
  check_one_bounce(corner_of_plates(),
                   {pixel_at(20, 57), pixel_at(32, 46), pixel_at(50, 45), pixel_at(32, 30)}, 1 << 14);
}

TEST_CASE("one bounce is the integral over the other plate with many paths, too", "[long]") {
  check_one_bounce(parallel_plates(), {pixel_at(31, 31), pixel_at(3, 60), pixel_at(63, 0)}, 1 << 20);
  check_one_bounce(corner_of_plates(), {pixel_at(20, 57), pixel_at(32, 46), pixel_at(50, 45)}, 1 << 20);
}

TEST_CASE("diodes of any intensity and phase light what bounces as they light what does not") {
  const std::vector<Plate> plates = corner_of_plates();
  const Sensor sensor = wide_sensor({4, 4}, 1.2);
  std::vector<Illuminator> lights{light_of_plates(sensor), light_of_plates(sensor)};
  lights[0].diodes[0].intensity_w_sr = 0;
  lights[0].diodes[1].intensity_w_sr = 5;
  lights[1].diodes[0].intensity_w_sr = 0.5;
  lights[1].diodes[1].intensity_w_sr = 0;
  lights[1].modulation_phase_rad = 2.0;
  const auto frame = frame_of(scene_of(plates), sensor, lights, bouncing(1, 1 << 12));
  const reference::FrameReturn &found = frame.returns[0];
  for (std::uint32_t pixel = 0; pixel < 16; ++pixel) {
    if (frame.coverage[pixel] == 0)
      continue;
    const auto of = [&](std::size_t light) {
      return one_bounce_of(plates, sensor, frame, pixel, lights[light].diodes, 60);
    };
    CHECK(std::abs(indirect_z(found, pixel) - of(0) - of(1) * std::polar(1.0, 2.0)) <
          4.5 * found.z_error[pixel]);
  }
}

TEST_CASE("paths are spread over a pixel's samples") {
  Sensor sensor = wide_sensor({2, 2}, 1.2);
  sensor.samples = 4;
  Sensor fine = wide_sensor({8, 8}, 1.2);
  fine.vignetting = sensor.vignetting = Vignetting::cos4;
  const Scene scene = scene_of(corner_of_plates());
  const auto coarse_frame = frame_of(scene, sensor, {light_of_plates(sensor)}, bouncing(1, 1 << 15));
  const auto fine_frame = frame_of(scene, fine, {light_of_plates(fine)}, bouncing(1, 1 << 14));
  for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
    std::complex<double> mean;
    double variance = 0;
    for (std::uint32_t sample = 0; sample < 16; ++sample) {
      const std::size_t at = (pixel / 2 * 4 + sample / 4) * 8 + pixel % 2 * 4 + sample % 4;
      mean += indirect_z(fine_frame.returns[0], at) / 16.0;
      variance += std::pow(fine_frame.returns[0].z_error[at] / 16, 2);
    }
    const double error = std::sqrt(variance + std::pow(coarse_frame.returns[0].z_error[pixel], 2));
    CHECK(std::abs(indirect_z(coarse_frame.returns[0], pixel) - mean) < 4 * error);
  }
}

TEST_CASE("a disc receives what bounces, and blocks and sends nothing") {
  const std::vector<Plate> plates = parallel_plates();
  const Sensor sensor = axial_sensor();
  const auto without =
      frame_of(scene_of(plates), sensor, {light_of_plates(sensor)}, bouncing(all_bounces, 4096));
  Scene scene = scene_of(plates);
  // Before the lens, which it hides the plate from; and one on all ways between the plates.
  const auto vertex = static_cast<std::uint32_t>(scene.positions_m.size());
  scene.positions_m.push_back(sensor.world_from_camera.point({0.0, 0.0, 1.0}));
  scene.positions_m.push_back(sensor.world_from_camera.point({0.0, 0.0, -0.4}));
  scene.surfaces.push_back({0.8});
  const auto surface = static_cast<std::uint32_t>(scene.surfaces.size() - 1);
  scene.discs = {{vertex + 1, 5.0, surface, 0}};
  const auto beside = frame_of(scene, sensor, {light_of_plates(sensor)}, bouncing(all_bounces, 4096));
  CHECK(indirect_z(beside.returns[0], 0) == indirect_z(without.returns[0], 0));

  scene.discs = {{vertex, 0.1, surface, 0}};
  const auto frame = frame_of(scene, sensor, {light_of_plates(sensor)}, bouncing(1, 1 << 14));
  REQUIRE(frame.range_m[0] == Approx(1));
  const LitPoint point{{0, 0, 1}, {0, 0, -1}, 0.8, diodes_of_plates};
  const auto expected = one_bounce(point, plates[1], wavenumber_20mhz_rad_m, 100);
  CHECK(std::abs(indirect_z(frame.returns[0], 0) - expected) < 4 * frame.returns[0].z_error[0]);
}
