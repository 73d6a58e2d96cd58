// What the reference makes of light that bounces: channels, taps, waveforms, errors, bits.

#include "tests/reference/bounce_fixture.h"

#include <catch2/catch.hpp>
#include <cstring>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

const std::vector<Diode> corner_diodes{diode_at({0.1, 0, 0}), diode_at({-0.05, -0.1, 0.02})};

Illuminator corner_light(const Sensor &sensor) { return {"diodes", sensor.world_from_camera, corner_diodes}; }

reference::Frame corner_frame(const Sensor &sensor, const reference::Options &options) {
  return frame_of(scene_of(corner_of_plates()), sensor, {corner_light(sensor)}, options);
}

bool same_z(const std::vector<std::complex<double>> &a, const std::vector<std::complex<double>> &b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

} // namespace

TEST_CASE("a sine's taps hold what bounces as they hold z") {
  Sensor sensor = wide_sensor({4, 4}, 1.2);
  sensor.taps = 5;
  const auto frame = corner_frame(sensor, bouncing(2, 256));
  const reference::FrameReturn &found = frame.returns[0];
  for (std::size_t pixel = 0; pixel < 16; ++pixel)
    for (std::uint32_t k = 0; k < 5; ++k)
      CHECK(found.taps[k][pixel] ==
            Approx(std::real(found.z[pixel] * std::polar(1.0, -full_turn_rad * k / 5))).margin(1e-15));
}

TEST_CASE("any waveform's taps hold what bounces") {
  Sensor sensor = wide_sensor({4, 4}, 1.2);
  sensor.taps = 5;
  const auto of_sine = corner_frame(sensor, bouncing(2, 256));
  sensor.waveform = {Waveform::Kind::harmonics, {1.0}};
  const auto of_harmonic = corner_frame(sensor, bouncing(2, 256));
  sensor.waveform = {Waveform::Kind::square, {}};
  const auto of_square = corner_frame(sensor, bouncing(2, 256));
  for (std::size_t pixel = 0; pixel < 16; ++pixel) {
    if (of_sine.coverage[pixel] == 0)
      continue;
    const auto z = of_sine.returns[0].z[pixel];
    CHECK(std::abs(of_harmonic.returns[0].z[pixel] - z) < 1e-14);
    CHECK(of_harmonic.returns[0].multipath_error_m[pixel] ==
          Approx(of_sine.returns[0].multipath_error_m[pixel]).epsilon(1e-9));
    // The triangle wave's fundamental is 8 / pi^2; what its others add to five taps is below a tenth of that.
    CHECK(std::abs(of_square.returns[0].z[pixel] - 8 / std::pow(std::numbers::pi, 2) * z) <
          0.1 * std::abs(z));
    std::complex<double> of_taps;
    for (std::uint32_t k = 0; k < 5; ++k)
      of_taps += 0.4 * of_square.returns[0].taps[k][pixel] * std::polar(1.0, full_turn_rad * k / 5);
    CHECK(std::abs(of_taps - of_square.returns[0].z[pixel]) < 1e-14);
  }
}

TEST_CASE("one set of paths serves every frequency") {
  Sensor sensor = wide_sensor({3, 3}, 1.2);
  sensor.modulation_hz = {20e6, 100e6};
  const auto both = corner_frame(sensor, bouncing(all_bounces, 128));
  sensor.modulation_hz = {100e6};
  CHECK(same_z(both.returns[1].z, corner_frame(sensor, bouncing(all_bounces, 128)).returns[0].z));
}

TEST_CASE("light that bounces has the same bits in every run and whichever thread computes a pixel") {
  const Sensor sensor = wide_sensor({8, 8}, 1.2);
  const auto frame = corner_frame(sensor, bouncing(all_bounces, 100));
  CHECK(same_z(frame.returns[0].z, corner_frame(sensor, bouncing(all_bounces, 100)).returns[0].z));
  for (std::uint32_t pixel = 0; pixel < 64; pixel += 7) {
    // One row, so one thread.
    const auto alone = corner_frame(sensor, bouncing(all_bounces, 100, {pixel}));
    CHECK(same_z(alone.returns[0].z, {frame.returns[0].z[pixel]}));
    CHECK(alone.returns[0].z_error[0] == frame.returns[0].z_error[pixel]);
  }
}

TEST_CASE("paths are rounded up to whole replicates, and are 1024 unless said") {
  const Sensor sensor = wide_sensor({2, 2}, 1.2);
  CHECK(same_z(corner_frame(sensor, bouncing(1, 17)).returns[0].z,
               corner_frame(sensor, bouncing(1, 32)).returns[0].z));
  CHECK(same_z(corner_frame(sensor, bouncing(1, 0)).returns[0].z,
               corner_frame(sensor, bouncing(1, 1024)).returns[0].z));
}

TEST_CASE("standard errors are as large as errors are, for one bounce") {
  const Sensor sensor = wide_sensor({16, 16}, 1.2);
  const auto frame = corner_frame(sensor, bouncing(1, 128));
  const reference::FrameReturn &found = frame.returns[0];
  int pixels = 0, within_two = 0;
  double squares = 0;
  for (std::uint32_t pixel = 0; pixel < 256; ++pixel) {
    if (frame.coverage[pixel] == 0)
      continue;
    const auto z =
        found.direct_z[pixel] + one_bounce_of(corner_of_plates(), sensor, frame, pixel, corner_diodes, 30);
    const double expected_m = multipath_of_m(z, found.direct_z[pixel], sensor.ambiguity_m());
    const double errors = (found.multipath_m[pixel] - expected_m) / found.multipath_error_m[pixel];
    ++pixels;
    within_two += std::abs(errors) < 2;
    squares += errors * errors;
  }
  REQUIRE(pixels >= 100);
  // Of Student's distribution with 15 degrees of freedom 93.6 % lie within 2, +- 2.5 % for 100 pixels.
  CHECK(within_two > 0.86 * pixels);
  CHECK(within_two < pixels);
  CHECK(squares / pixels == Approx(15.0 / 13.0).epsilon(0.4));
}

TEST_CASE("the channels of what bounces follow from z and from its direct part") {
  const Sensor sensor = wide_sensor({8, 8}, 1.2);
  const auto frame = corner_frame(sensor, bouncing(2, 64));
  const auto direct = corner_frame(sensor, bouncing(0, 64));
  const reference::FrameReturn &found = frame.returns[0];
  CHECK(direct.returns[0].multipath_m.empty());
  CHECK(same_z(found.direct_z, direct.returns[0].z));
  const Return rounded = reference::to_measurement(frame).returns[0];
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    if (frame.coverage[pixel] == 0) {
      CHECK(found.direct_amplitude[pixel] == 0);
      CHECK(found.z_error[pixel] == 0);
      for (const auto *channel : {&found.direct_phase_rad, &found.direct_distance_m, &found.multipath_m,
                                  &found.multipath_error_m, &found.indirect_share})
        CHECK(std::isnan((*channel)[pixel]));
      continue;
    }
    CHECK(found.direct_amplitude[pixel] == direct.returns[0].amplitude[pixel]);
    CHECK(found.direct_phase_rad[pixel] == direct.returns[0].phase_rad[pixel]);
    CHECK(found.direct_distance_m[pixel] == direct.returns[0].distance_m[pixel]);
    CHECK(
        found.multipath_m[pixel] ==
        Approx(std::remainder(found.distance_m[pixel] - found.direct_distance_m[pixel], sensor.ambiguity_m()))
            .margin(1e-12));
    CHECK(found.indirect_share[pixel] ==
          Approx(std::abs(indirect_z(found, pixel)) / found.amplitude[pixel]).epsilon(1e-9));
    CHECK(found.multipath_error_m[pixel] > 0);
    CHECK(found.multipath_error_m[pixel] <=
          found.z_error[pixel] / found.amplitude[pixel] * sensor.ambiguity_m() / full_turn_rad);
    CHECK(rounded.direct_amplitude[pixel] == static_cast<float>(found.direct_amplitude[pixel]));
    CHECK(rounded.direct_phase_rad[pixel] == static_cast<float>(found.direct_phase_rad[pixel]));
    CHECK(rounded.direct_distance_m[pixel] == static_cast<float>(found.direct_distance_m[pixel]));
    CHECK(rounded.multipath_m[pixel] == static_cast<float>(found.multipath_m[pixel]));
    CHECK(rounded.multipath_error_m[pixel] == static_cast<float>(found.multipath_error_m[pixel]));
    CHECK(rounded.indirect_share[pixel] == static_cast<float>(found.indirect_share[pixel]));
  }
}

TEST_CASE("where no light comes directly all of it has bounced") {
  // Hidden from the wall that the lens sees, not from the one behind the lens.
  std::vector<Plate> plates = parallel_plates();
  plates.push_back({{0.1, 0.0, 0.35}, {0.3, 0, 0}, {0, 0.3, 0}, {0.0, true}});
  const Sensor sensor = axial_sensor();
  const auto frame = frame_of(scene_of(plates), sensor,
                              {diode_beside_lens(sensor, diode_at({0.2, 0.1, 0.3}))}, bouncing(1, 256));
  const reference::FrameReturn &found = frame.returns[0];
  REQUIRE(found.direct_z[0] == 0.0);
  CHECK(found.amplitude[0] > 0);
  CHECK(found.indirect_share[0] == 1);
  CHECK(std::isnan(found.direct_distance_m[0]));
  CHECK(std::isnan(found.multipath_m[0]));
  CHECK(std::isnan(found.multipath_error_m[0]));
  CHECK(found.distance_m[0] > 0);
}
