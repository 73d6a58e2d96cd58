// Frequencies, taps and waveforms: what the camera makes of one path whose length is known.

#include "engine/reference/light/return_sum.h"
#include "engine/reference/reference.h"
#include "tests/reference/monostatic_frame.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A column of pixels that look at slanted_wall(); ambiguity range 1.5 m.
Sensor column_sensor(const Waveform &waveform, std::uint32_t taps) {
  Sensor sensor;
  sensor.resolution = {1, 3000};
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(sensor.focal_length_m / 3000);
  sensor.modulation_hz = {100e6};
  sensor.waveform = waveform;
  sensor.taps = taps;
  return sensor;
}

// z = 2 m + y: 1.5 to 4.5 m from the lens, seen from slopes of -1/2 to 1/2.
Scene slanted_wall() {
  SceneBuilder builder;
  builder.add_mesh({{-9, -1, 1}, {-9, 3, 5}, {9, 3, 5}, {9, -1, 1}}, {{0, 1, 2}, {0, 2, 3}});
  return builder.scene();
}

reference::Frame column_frame(const Waveform &waveform, std::uint32_t taps) {
  return monostatic_frame(slanted_wall(), column_sensor(waveform, taps));
}

double path_phase_rad(const reference::Frame &frame, std::size_t pixel) {
  return full_turn_rad * frame.range_m[pixel] / frame.returns[0].ambiguity_m;
}

// The largest difference between two channels.
double largest_difference(const std::vector<double> &a, const std::vector<double> &b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// The Fourier series of the triangle wave up to the harmonic `last`.
Waveform truncated_triangle(int last) {
  Waveform waveform{Waveform::Kind::harmonics, {}};
  for (int h = 1; h <= last; ++h)
    waveform.harmonics.push_back(h % 2 == 1 ? 8 / std::pow(std::numbers::pi * h, 2) : 0);
  return waveform;
}

bool same_bits(const std::vector<double> &a, const std::vector<double> &b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

const Waveform sine{}, square{Waveform::Kind::square, {}};

} // namespace

TEST_CASE("every frequency is measured as if it were alone") {
  Random random(41);
  const Pose world_from_camera = random.pose(2);
  const Scene scene = random_triangles(random, 60, world_from_camera);
  const Illuminator illuminator = random_illuminator(random, 5, world_from_camera);
  Sensor sensor;
  sensor.resolution = {16, 12};
  sensor.pixel_pitch_m = glm::dvec2(0.01);
  sensor.world_from_camera = world_from_camera;
  sensor.waveform = GENERATE(as<Waveform>{}, sine, square, truncated_triangle(3));
  const std::vector<double> modulation_hz{20e6, 80.1e6, 3e5};
  sensor.modulation_hz = modulation_hz;
  const auto together = reference::simulate(scene, sensor, {illuminator}, Backscatter::lambert);
  REQUIRE(together.returns.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    sensor.modulation_hz = {modulation_hz[i]};
    const auto alone = reference::simulate(scene, sensor, {illuminator}, Backscatter::lambert);
    CHECK(together.returns[i].ambiguity_m == sensor.ambiguity_m());
    CHECK(same_bits(together.returns[i].amplitude, alone.returns[0].amplitude));
    CHECK(same_bits(together.returns[i].phase_rad, alone.returns[0].phase_rad));
    CHECK(same_bits(together.returns[i].distance_m, alone.returns[0].distance_m));
    CHECK(same_bits(together.returns[i].taps[1], alone.returns[0].taps[1]));
  }
}

TEST_CASE("a tap is the correlation at the path's phase less its own") {
  const auto [waveform, expected] = GENERATE(table<Waveform, double (*)(double)>(
      {{sine, [](double x) { return std::cos(x); }},
       {square,
        [](double x) { return 1 - std::abs(std::remainder(x, full_turn_rad)) / (full_turn_rad / 4); }},
       {{Waveform::Kind::harmonics, {0.9, 0.2, -0.1}},
        [](double x) { return 0.9 * std::cos(x) + 0.2 * std::cos(2 * x) - 0.1 * std::cos(3 * x); }}}));
  const std::uint32_t taps = GENERATE(3u, 4u, 7u);
  const auto frame = column_frame(waveform, taps);
  REQUIRE(frame.returns[0].taps.size() == taps);
  double largest_error = 0;
  for (std::size_t pixel = 0; pixel < frame.range_m.size(); ++pixel)
    for (std::uint32_t k = 0; k < taps; ++k) {
      const double x = path_phase_rad(frame, pixel) - full_turn_rad * k / taps;
      const double weight = 1 / std::pow(frame.range_m[pixel], 2);
      largest_error =
          std::max(largest_error, std::abs(frame.returns[0].taps[k][pixel] - weight * expected(x)));
    }
  CHECK(largest_error < 1e-13);
}

TEST_CASE("the triangle wave is 1 in phase, -1 in opposite phase and straight between") {
  CHECK(reference::correlation(square, 0) == 1);
  CHECK(reference::correlation(square, 0.5) == -1);
  CHECK(reference::correlation(square, -0.5) == -1);
  CHECK(reference::correlation(square, 3.25) == 0);
  CHECK(reference::correlation(square, -0.125) == 0.5);
  CHECK(reference::correlation(square, 0.375) == -0.5);
}

TEST_CASE("a camera takes from its taps what they hold at its frequency") {
  const auto waveform = GENERATE(as<Waveform>{}, sine, square, truncated_triangle(5));
  const std::uint32_t taps = GENERATE(3u, 5u, 16u);
  const auto frame = column_frame(waveform, taps);
  const reference::FrameReturn &found = frame.returns[0];
  for (std::size_t pixel = 0; pixel < frame.range_m.size(); pixel += 101) {
    std::complex<double> z = 0;
    for (std::uint32_t k = 0; k < taps; ++k)
      z += 2.0 / taps * found.taps[k][pixel] * std::polar(1.0, full_turn_rad * k / taps);
    CHECK(std::abs(z - found.z[pixel]) < 1e-15);
    CHECK(found.amplitude[pixel] == Approx(std::abs(found.z[pixel])).epsilon(1e-15));
    CHECK(std::abs(std::remainder(found.phase_rad[pixel] - std::arg(z), full_turn_rad)) < 1e-14);
  }
}

TEST_CASE("square light wiggles") {
  const auto [taps, largest_deg] = GENERATE(
      table<std::uint32_t, double>({{3, 1.1170}, {4, 4.0746}, {5, 0.2325}, {6, 1.1170}, {8, 0.4594}}));
  const auto frame = column_frame(square, taps);
  REQUIRE(frame.range_m.back() - frame.range_m.front() > frame.returns[0].ambiguity_m);
  double largest_rad = 0;
  for (std::size_t pixel = 0; pixel < frame.range_m.size(); ++pixel)
    largest_rad = std::max(
        largest_rad, std::abs(std::remainder(frame.returns[0].phase_rad[pixel] - path_phase_rad(frame, pixel),
                                             full_turn_rad)));
  CHECK(largest_rad * 180 / std::numbers::pi == Approx(largest_deg).epsilon(0).margin(0.001));
}

TEST_CASE("a single harmonic is a sine") {
  const std::uint32_t taps = GENERATE(3u, 4u, 9u);
  const auto single = column_frame({Waveform::Kind::harmonics, {1}}, taps);
  const auto exact = column_frame(sine, taps);
  CHECK(largest_difference(single.returns[0].amplitude, exact.returns[0].amplitude) < 1e-12);
  CHECK(largest_difference(single.returns[0].phase_rad, exact.returns[0].phase_rad) < 1e-12);
  CHECK(largest_difference(single.returns[0].distance_m, exact.returns[0].distance_m) < 1e-12);
  for (std::uint32_t k = 0; k < taps; ++k)
    CHECK(largest_difference(single.returns[0].taps[k], exact.returns[0].taps[k]) < 1e-12);
}

TEST_CASE("the triangle's harmonics approach square light as their number grows") {
  const auto exact = column_frame(square, 4);
  for (const int last : {1, 9, 99}) {
    const auto truncated = column_frame(truncated_triangle(last), 4);
    // The harmonics left out add up to most in phase: to the sum of 8 / (pi h)^2 over the odd h beyond.
    const double left_out = 4 / (std::numbers::pi * std::numbers::pi * (last + 1));
    double largest = 0;
    for (std::size_t pixel = 0; pixel < exact.range_m.size(); ++pixel)
      for (std::size_t k = 0; k < 4; ++k)
        largest = std::max(
            largest, std::pow(exact.range_m[pixel], 2) *
                         std::abs(truncated.returns[0].taps[k][pixel] - exact.returns[0].taps[k][pixel]));
    CHECK(largest < left_out);
    CHECK(largest > 0.9 * left_out);
  }
}

TEST_CASE("without light every tap is 0 and there is no phase, whatever the waveform") {
  Sensor sensor = axial_sensor({2, 1});
  sensor.waveform = GENERATE(as<Waveform>{}, sine, square, truncated_triangle(3));
  sensor.taps = 5;
  const Scene scene = GENERATE(Scene{}, wall_at(2));
  // Behind the wall.
  const auto frame = reference::simulate(scene, sensor, {diode_beside_lens(sensor, diode_at({0, 0, 4}))},
                                         Backscatter::lambert);
  const reference::FrameReturn &found = frame.returns[0];
  REQUIRE(found.taps.size() == 5);
  for (const std::vector<double> &tap : found.taps)
    CHECK(same_bits(tap, {0, 0}));
  CHECK(found.amplitude == std::vector<double>{0, 0});
  CHECK(std::isnan(found.phase_rad[0]));
  CHECK(std::isnan(found.distance_m[1]));
}
