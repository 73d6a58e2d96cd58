// The camera's figures found again from its frames, as EMVA Standard 1288 measures them.

#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Line {
  double slope, offset;
};

Line fitted(const std::vector<double> &x, const std::vector<double> &y) {
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return {xy / xx, mean_y - xy / xx * mean_x};
}

// The mean of tap A of image 0 and its temporal variance, from pairs of frames.
struct Transfer {
  double mean_dn, variance_dn2;
};

Transfer transfer_of(const LightLevels &levels, std::uint32_t pairs) {
  Moments all;
  double apart = 0.0, count = 0.0;
  for (std::uint32_t pair = 0; pair < pairs; ++pair) {
    const Return first = noisy_frame(levels, 2 * pair).returns[0],
                 second = noisy_frame(levels, 2 * pair + 1).returns[0];
    for (std::size_t i = 0; i < first.tap_a_dn[0].size(); ++i) {
      const double a = first.tap_a_dn[0][i], b = second.tap_a_dn[0][i];
      all.add(a);
      all.add(b);
      apart += 0.5 * (a - b) * (a - b);
      count += 1.0;
    }
  }
  return {all.mean(), apart / count};
}

} // namespace

TEST_CASE("the photon transfer's slope is the gain") {
  Electronics electronics = plain_electronics();
  electronics.dsnu_e = 40.0;
  electronics.prnu = 0.01;
  std::vector<double> means, variances;
  for (const double signal_e : {1000.0, 5000.0, 10e3, 20e3, 30e3, 40e3}) {
    const Transfer found = transfer_of(light_levels(electronics, 4, {signal_e}, 0.3, 400), 200);
    means.push_back(found.mean_dn);
    variances.push_back(found.variance_dn2);
  }
  const double gain = fitted(means, variances).slope;
  fmt::print("photon transfer: gain {:.6f} DN/e found, {:.6f} set\n", gain, electronics.gain_dn_per_e);
  CHECK(gain == Approx(electronics.gain_dn_per_e).epsilon(0.01));
}

TEST_CASE("read noise and dark current are found again in dark frames") {
  Electronics electronics = plain_electronics();
  electronics.dark_current_e_per_s = 20e3;
  const double gain = electronics.gain_dn_per_e;
  std::vector<double> times_s, means_e, variances_e2;
  for (const double time_s : {1e-4, 0.01, 0.02, 0.05, 0.1}) {
    electronics.integration_time_s = time_s;
    const Transfer found = transfer_of(light_levels(electronics, 4, {0.0}, 0.3, 400), 250);
    times_s.push_back(time_s);
    means_e.push_back((found.mean_dn - electronics.offset_dn) / gain);
    variances_e2.push_back((found.variance_dn2 - 1.0 / 12.0) / (gain * gain));
  }
  // Each tap has half of the pixel's dark current; its variance grows as its mean does.
  const double dark_e_per_s = 2.0 * fitted(times_s, means_e).slope;
  const double from_variance_e_per_s = 2.0 * fitted(times_s, variances_e2).slope;
  const double read_noise_e = std::sqrt(fitted(times_s, variances_e2).offset);
  fmt::print("dark frames: {:.1f} and {:.1f} e/s found, {} set; read noise {:.3f} e found, {} set\n",
             dark_e_per_s, from_variance_e_per_s, electronics.dark_current_e_per_s, read_noise_e,
             electronics.read_noise_e);
  CHECK(dark_e_per_s == Approx(20e3).epsilon(0.01));
  CHECK(from_variance_e_per_s == Approx(20e3).epsilon(0.03));
  CHECK(read_noise_e == Approx(25.0).epsilon(0.01));
}

TEST_CASE("the fixed pattern has its deviations and is the same in every frame and at every frequency") {
  Electronics electronics = plain_electronics();
  electronics.read_noise_e = 0.0;
  electronics.dsnu_e = 100.0;
  electronics.prnu = 0.02;
  electronics.gain_dn_per_e = 5.0;
  electronics.adc_bits = 20;
  electronics.frames_averaged = 400;
  electronics.dark_current_e_per_s = 0.0;
  for (const double signal_e : {0.0, 20e3}) {
    const LightLevels levels = light_levels(electronics, 3, {signal_e}, 0.0, 4000);
    const Return frame = noisy_frame(levels, 5).returns[0], other = noisy_frame(levels, 6).returns[0];
    Moments over_pixels, apart, taps_together;
    const double mean = 0.5 * (signal_e + 0.6 * signal_e);
    for (std::size_t i = 0; i < frame.tap_a_e[0].size(); ++i) {
      over_pixels.add(frame.tap_a_e[0][i]);
      apart.add(frame.tap_a_e[0][i] - other.tap_a_e[0][i]);
      taps_together.add((frame.tap_a_e[0][i] - mean) * (frame.tap_b_e[0][i] - 0.2 * signal_e));
    }
    const double expected = std::hypot(100.0, 0.02 * mean), temporal = std::sqrt(mean / 400.0);
    CHECK(std::sqrt(over_pixels.variance()) == Approx(std::hypot(expected, temporal)).epsilon(0.04));
    CHECK(std::sqrt(apart.variance()) == Approx(std::sqrt(2.0) * temporal).epsilon(0.05).margin(0.01));
    CHECK(std::abs(taps_together.mean()) < 4.0 * std::sqrt(taps_together.variance() / 4000.0));
  }
}
