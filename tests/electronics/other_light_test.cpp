// The light of another camera beside the integral over the exposure that it stands for.

#include "engine/electronics/other_light.h"
#include "engine/model/tap_sequence.h"
#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>
#include <complex>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
constexpr double other_amplitude = 0.3, other_phase_rad = 2.2, other_mean = 0.4;

// The mean of 2 cos(2 pi f_other t - phi) cos(2 pi f t - theta) over an exposure, by the midpoint rule.
double mean_of_product(double modulation_hz, double other_hz, double reference_rad, double begin_s,
                       double integration_time_s) {
  constexpr int steps = 400'000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = begin_s + integration_time_s * (i + 0.5) / steps;
    sum += 2.0 * std::cos(turn_rad * std::fmod(other_hz * t, 1.0) - other_phase_rad) *
           std::cos(turn_rad * std::fmod(modulation_hz * t, 1.0) - reference_rad);
  }
  return sum / steps;
}

Measurement others_frame(std::size_t pixels) {
  Measurement seen;
  Return &of = seen.returns.emplace_back();
  of.amplitude.assign(pixels, static_cast<float>(other_amplitude));
  of.phase_rad.assign(pixels, static_cast<float>(other_phase_rad));
  of.amplitude[0] = 0.0f;
  of.phase_rad[0] = std::numeric_limits<float>::quiet_NaN();
  seen.mean_radiance.assign(pixels, static_cast<float>(other_mean));
  return seen;
}

LightLevels lit_pixels(std::uint32_t images, double integration_time_s) {
  Electronics electronics = plain_electronics();
  electronics.integration_time_s = integration_time_s;
  return light_levels(electronics, images, {2000.0}, 1.1, 3);
}

} // namespace

TEST_CASE("what is left of another camera's beat is the mean of its product with the reference") {
  fmt::print("{:<12}{:>12}{:>14}{:>12}{:>12}\n", "apart, Hz", "begins, s", "exposure, s", "largest",
             "off by");
  for (const double apart_hz : {0.0, 700.0, -2500.0, 5e3, 17.3e3, 1e4, 3e6})
    for (const double begin_s : {0.0, 0.0123}) {
      constexpr double integration_time_s = 1e-4, modulation_hz = 20e6;
      for (const std::uint32_t images : {3u, 4u}) {
        LightLevels levels = lit_pixels(images, integration_time_s);
        levels.sensor.modulation_hz = {modulation_hz};
        const Measurement seen = others_frame(3);
        double largest = 0.0, off = 0.0;
        for (std::size_t k = 0; k < images; ++k) {
          std::vector<float> correlation(3, 0.5f);
          add_beat(levels.sensor, 0, k, begin_s, other_light_of(modulation_hz + apart_hz, seen), correlation);
          CHECK(correlation[0] == 0.5f);
          const double expected =
              other_amplitude * mean_of_product(modulation_hz, modulation_hz + apart_hz,
                                                turn_rad * static_cast<double>(k) / images, begin_s,
                                                integration_time_s);
          largest = std::max(largest, std::abs(expected));
          off = std::max(off, std::abs(correlation[2] - 0.5 - expected));
        }
        // The product's other frequency, the sum of both, leaves 1 / (pi 40 MHz 0.1 ms) at most.
        CHECK(off < 8.1e-5 * other_amplitude + 1e-7);
        if (images == 4)
          fmt::print("{:<12}{:>12}{:>14}{:>12.5f}{:>12.1e}\n", apart_hz, begin_s, integration_time_s, largest,
                     off);
      }
    }
}

TEST_CASE("another camera of the same frequency adds its complex return, whenever the frame is taken") {
  for (const std::uint32_t images : {3u, 4u, 8u}) {
    const LightLevels levels = lit_pixels(images, 1e-3);
    const Measurement seen = others_frame(3);
    Measurement frame = levels.noiseless;
    add_other_light(levels.sensor, 12.34, other_light_of(levels.sensor.modulation_hz[0], seen), frame);
    const std::complex<double> own = std::polar<double>(levels.noiseless.returns[0].amplitude[1],
                                                        levels.noiseless.returns[0].phase_rad[1]);
    const std::complex<double> sum = own + std::polar(other_amplitude, other_phase_rad);
    CHECK(frame.returns[0].amplitude[1] == Approx(std::abs(sum)).epsilon(1e-6));
    CHECK(frame.returns[0].phase_rad[1] == Approx(std::arg(sum)).epsilon(1e-6));
    CHECK(frame.returns[0].amplitude[0] == Approx(std::abs(own)).epsilon(1e-6));
    CHECK(frame.returns[0].taps.size() == images);
    CHECK(frame.mean_radiance[1] == Approx(levels.noiseless.mean_radiance[1] + other_mean).epsilon(1e-6));
  }
}

TEST_CASE("after whole turns of the beat another camera's light is background alone") {
  const LightLevels levels = lit_pixels(4, 1e-3);
  const Measurement seen = others_frame(3);
  Measurement frame = levels.noiseless;
  add_other_light(levels.sensor, 0.0, other_light_of(levels.sensor.modulation_hz[0] + 3e3, seen), frame);
  CHECK(frame.returns[0].amplitude[1] == Approx(levels.noiseless.returns[0].amplitude[1]).epsilon(1e-6));
  CHECK(frame.returns[0].phase_rad[1] == Approx(1.1).epsilon(1e-6));
  // And the electrons have its mean.
  Measurement without = levels.noiseless;
  count_electrons(levels.sensor, {.keep_taps = true}, without);
  count_electrons(levels.sensor, {.reads_taps = true, .keep_taps = true}, frame);
  CHECK(frame.returns[0].distance_noise_m[1] > without.returns[0].distance_noise_m[1]);
}

TEST_CASE("taps that are taken one after the other meet the beat at other phases") {
  LightLevels levels = lit_pixels(4, 1e-5);
  levels.sensor.tap_interval_s = 1e-3;
  const Measurement seen = others_frame(3);
  Measurement frame = levels.noiseless;
  const double apart_hz = 250.0; // a quarter of a turn from tap to tap
  add_other_light(levels.sensor, 0.0, other_light_of(levels.sensor.modulation_hz[0] + apart_hz, seen), frame);
  const double turned_rad = other_phase_rad - turn_rad * apart_hz * 0.5e-5;
  for (std::size_t k = 0; k < 4; ++k) {
    const double own =
        levels.noiseless.returns[0].amplitude[1] *
        std::cos(levels.noiseless.returns[0].phase_rad[1] - 0.25 * turn_rad * static_cast<double>(k));
    const double beat = other_amplitude * std::cos(turned_rad - 0.5 * turn_rad * static_cast<double>(k));
    CHECK(frame.returns[0].taps[k][1] == Approx(own + beat).margin(1e-4 * other_amplitude));
  }
}
