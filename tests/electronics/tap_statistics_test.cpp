// Mean and variance of every tap over 10,000 frames, from dark to full, beside theory.

#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <numbers>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t frames = 10'000;
constexpr double phase_rad = 1.1;

struct MeanAndVariance {
  double mean, variance;
};

double density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }
double share_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// min(X, most) of a normal X.
MeanAndVariance limited(const MeanAndVariance &of, double most) {
  const double deviation = std::sqrt(of.variance), at = (most - of.mean) / deviation;
  if (at > 8.0)
    return of;
  const double below = share_below(at), d = density(at);
  const double mean = of.mean * below - deviation * d + most * (1.0 - below);
  const double square = (of.mean * of.mean + of.variance) * below - deviation * (of.mean + most) * d +
                        most * most * (1.0 - below);
  return {mean, square - mean * mean};
}

// The electrons of a tap, (S + B + D) / 2 +- C S cos(phi - theta) / 2, and their variance.
MeanAndVariance theory_e(const LightLevels &levels, double signal_e, std::uint32_t image, bool tap_b) {
  const Electronics &of = *levels.sensor.electronics;
  const double background_e = electrons_of(of.background_radiance_w_m2_sr, levels.sensor);
  const double dark_e = of.dark_current_e_per_s * of.integration_time_s;
  const double theta_rad = 2.0 * std::numbers::pi * image / levels.sensor.taps;
  const double part_e = of.demodulation_contrast[0] * signal_e * std::cos(phase_rad - theta_rad);
  const double mean = 0.5 * (signal_e + background_e + dark_e + (tap_b ? -part_e : part_e));
  return limited({mean, mean + of.read_noise_e * of.read_noise_e}, of.full_well_e);
}

MeanAndVariance theory_dn(const MeanAndVariance &charge, const Electronics &of) {
  const double gain2 = of.gain_dn_per_e * of.gain_dn_per_e;
  const double rounding = charge.variance > 0.0 ? 1.0 / 12.0 : 0.0;
  return {of.gain_dn_per_e * charge.mean + of.offset_dn, gain2 * charge.variance + rounding};
}

// Of one row's pixels, in all frames.
struct TapMoments {
  Moments charge_e, number_dn;
};

void add_row(const std::vector<float> &channel, std::size_t row, std::uint32_t columns, Moments &to) {
  for (std::size_t i = row * columns; i < (row + 1) * columns; ++i)
    to.add(static_cast<double>(channel[i]));
}

void check(const std::string &name, const MeanAndVariance &theory, const Moments &found) {
  const double mean_error = std::sqrt(theory.variance / found.count());
  const double variance_error = theory.variance * std::sqrt(2.0 / found.count());
  fmt::print("{:<44}{:>12.4f}{:>12.4f}{:>12.3f}{:>12.3f}\n", name, theory.mean, found.mean(), theory.variance,
             found.variance());
  INFO(name);
  CHECK(std::abs(found.mean() - theory.mean) <= std::max(0.001 * theory.mean, 3.0 * mean_error));
  CHECK(std::abs(found.variance() - theory.variance) <=
        std::max(0.01 * theory.variance, 3.0 * variance_error) + 1e-9);
}

void check_levels(const std::string &name, const LightLevels &levels) {
  const std::size_t rows = levels.signal_e.size();
  const std::uint32_t images = levels.sensor.taps;
  const bool two_tap = levels.sensor.electronics->two_tap;
  std::vector<TapMoments> a(rows * images), b(rows * images);
  for (std::uint32_t number = 0; number < frames; ++number) {
    const Return frame = noisy_frame(levels, number).returns[0];
    for (std::size_t row = 0; row < rows; ++row)
      for (std::uint32_t k = 0; k < images; ++k) {
        add_row(frame.tap_a_e[k], row, levels.sensor.resolution.x, a[row * images + k].charge_e);
        add_row(frame.tap_a_dn[k], row, levels.sensor.resolution.x, a[row * images + k].number_dn);
        if (!two_tap)
          continue;
        add_row(frame.tap_b_e[k], row, levels.sensor.resolution.x, b[row * images + k].charge_e);
        add_row(frame.tap_b_dn[k], row, levels.sensor.resolution.x, b[row * images + k].number_dn);
      }
  }
  for (std::size_t row = 0; row < rows; ++row)
    for (std::uint32_t k = 0; k < images; ++k)
      for (const bool tap_b : {false, true}) {
        if (tap_b && !two_tap)
          continue;
        const TapMoments &found = (tap_b ? b : a)[row * images + k];
        const MeanAndVariance theory = theory_e(levels, levels.signal_e[row], k, tap_b);
        const std::string what =
            fmt::format("{}, {:.0f} e, image {}, tap {}", name, levels.signal_e[row], k, tap_b ? "B" : "A");
        check(what + ", e", theory, found.charge_e);
        check(what + ", DN", theory_dn(theory, *levels.sensor.electronics), found.number_dn);
      }
}

void print_tap_heading() {
  fmt::print("{:<44}{:>12}{:>12}{:>12}{:>12}\n", "tap over 10,000 frames", "mean", "found", "variance",
             "found");
}

const std::vector<double> dark_to_full_e{0.0, 30.0, 400.0, 5000.0, 60e3, 95e3};

} // namespace

TEST_CASE("each tap's mean and variance follow theory, of two taps") {
  print_tap_heading();
  for (const std::uint32_t images : {3u, 4u, 8u})
    check_levels(fmt::format("two taps, N = {}", images),
                 light_levels(plain_electronics(), images, dark_to_full_e, phase_rad, 8));
}

TEST_CASE("each tap's mean and variance follow theory, of one tap") {
  Electronics electronics = plain_electronics();
  electronics.two_tap = false;
  print_tap_heading();
  for (const std::uint32_t images : {3u, 4u, 8u})
    check_levels(fmt::format("one tap, N = {}", images),
                 light_levels(electronics, images, dark_to_full_e, phase_rad, 8));
}

TEST_CASE("each tap's mean and variance follow theory without read noise and with background") {
  Electronics electronics = plain_electronics();
  electronics.read_noise_e = 0.0;
  electronics.gain_dn_per_e = 4.0;
  electronics.adc_bits = 20;
  electronics.background_radiance_w_m2_sr = 0.002;
  print_tap_heading();
  const LightLevels levels = light_levels(electronics, 4, {0.0, 100.0, 2000.0}, phase_rad, 8);
  check_levels("no read noise", levels);
  const Measurement frame = noisy_frame(levels, 3);
  for (const float charge : frame.returns[0].tap_a_e[0])
    CHECK(charge == std::floor(charge));
}

TEST_CASE("small read noise is drawn beside whole electrons") {
  Electronics electronics = plain_electronics();
  electronics.read_noise_e = 0.2;
  electronics.gain_dn_per_e = 50.0;
  electronics.adc_bits = 20;
  print_tap_heading();
  const LightLevels levels = light_levels(electronics, 4, {10.0, 300.0}, phase_rad, 8);
  check_levels("read noise 0.2 e", levels);
  // Most lie within two of its deviations of a whole number.
  const Measurement frame = noisy_frame(levels, 3);
  int near = 0, all = 0;
  for (const float charge : frame.returns[0].tap_a_e[0]) {
    near += std::abs(charge - std::round(charge)) < 0.4f ? 1 : 0;
    ++all;
  }
  CHECK(near > 0.85 * all);
}

TEST_CASE("averaged frames have a part of the variance, and background suppression leaves the difference") {
  Electronics electronics = plain_electronics();
  electronics.frames_averaged = 4;
  LightLevels levels = light_levels(electronics, 4, {4000.0});
  Moments averaged;
  for (std::uint32_t number = 0; number < 2000; ++number)
    add_row(noisy_frame(levels, number).returns[0].tap_a_e[0], 0, 16, averaged);
  const MeanAndVariance single = theory_e(levels, 4000.0, 0, false);
  CHECK(averaged.variance() == Approx(single.variance / 4.0).epsilon(0.03));

  electronics.frames_averaged = 1;
  electronics.sbi_e = 80e3;
  electronics.background_radiance_w_m2_sr =
      100e3 / electrons_of(1.0, light_levels(electronics, 4, {0.0}).sensor);
  levels = light_levels(electronics, 4, {20e3});
  Moments difference;
  for (std::uint32_t number = 0; number < 2000; ++number) {
    const Measurement frame = noisy_frame(levels, number);
    CHECK(frame.returns[0].saturated[0] == 0);
    difference.add(frame.returns[0].tap_a_e[1][0] - frame.returns[0].tap_b_e[1][0]);
  }
  const double expected_e = electronics.demodulation_contrast[0] * 20e3 * std::sin(phase_rad);
  CHECK(difference.mean() == Approx(expected_e).margin(3.0 * std::sqrt(difference.variance() / 2000.0)));
  levels.sensor.electronics->sbi_e = 0.0;
  CHECK(noisy_frame(levels, 0).returns[0].saturated[0] != 0);
}

TEST_CASE("parts of a pixel that are averaged have its light together, and noise each of its own") {
  Electronics electronics = plain_electronics();
  electronics.dsnu_e = 80.0;
  electronics.parts_averaged = 4;
  LightLevels levels = light_levels(electronics, 4, {4000.0}, phase_rad, 512); // of each part
  Moments over_pixels;
  Moments amplitude;
  std::vector<Moments> pixels(512);
  for (std::uint32_t number = 0; number < 600; ++number) {
    const Return frame = noisy_frame(levels, number).returns[0];
    for (std::size_t i = 0; i < 512; ++i)
      pixels[i].add(frame.tap_a_e[0][i]);
    amplitude.add(frame.amplitude[7] / levels.noiseless.returns[0].amplitude[7]);
  }
  double temporal = 0.0;
  for (const Moments &pixel : pixels) {
    temporal += pixel.variance() / 512.0;
    over_pixels.add(pixel.mean());
  }
  const MeanAndVariance single = theory_e(levels, 4000.0, 0, false);
  CHECK(over_pixels.mean() == Approx(single.mean).margin(4.0 * 80.0 / std::sqrt(4.0 * 512.0)));
  CHECK(temporal == Approx(single.variance / 4.0).epsilon(0.01));
  CHECK(std::sqrt(over_pixels.variance()) == Approx(80.0 / 2.0).epsilon(0.1));
  CHECK(amplitude.mean() == Approx(1.0).epsilon(0.01));
}

TEST_CASE("the mean of very many readings is as exact as that of few") {
  Electronics electronics = plain_electronics();
  electronics.read_noise_e = 3.0;
  electronics.full_well_e = 1e9;
  electronics.gain_dn_per_e = 1.0 / 3000.0; // noise of one digital number around 3,000
  electronics.offset_dn = 30.0;
  electronics.frames_averaged = 10'000;
  electronics.demodulation_contrast = {0.2};
  const LightLevels levels = light_levels(electronics, 3, {17e6}, phase_rad, 64);
  const Return frame = noisy_frame(levels, 1).returns[0];
  const MeanAndVariance dn = theory_dn(theory_e(levels, 17e6, 0, false), electronics);
  Moments found;
  for (const float number_dn : frame.tap_a_dn[0])
    found.add(number_dn);
  const double error_dn = std::sqrt(dn.variance / (10'000.0 * found.count()));
  fmt::print("10,000 readings: mean {:.5f} DN, found {:.5f}, standard error {:.5f}\n", dn.mean, found.mean(),
             error_dn);
  CHECK(std::abs(found.mean() - dn.mean) < 4.0 * error_dn);
  CHECK(found.variance() == Approx(dn.variance / 10'000.0).epsilon(0.5));
}

TEST_CASE(
    "where the ADC ends below the well, suppression of background does not help, and that is predicted") {
  Electronics electronics = plain_electronics();
  electronics.adc_bits = 10; // 983 DN above the offset are 12,288 e of 50,000
  electronics.sbi_e = 1e6;
  const LightLevels levels = light_levels(electronics, 4, {60e3}, phase_rad);
  const Return frame = noisy_frame(levels, 0).returns[0];
  CHECK(frame.saturated[0] != 0);
  CHECK(std::isnan(frame.distance_noise_m[0]));
}
