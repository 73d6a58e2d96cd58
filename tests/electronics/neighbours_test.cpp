// A pixel's electrons are its own: its neighbours change no bit of them, and chance does not join them.

#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <utility>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("a pixel's electrons do not depend on its neighbours, however close to dark its taps are") {
  constexpr std::uint32_t columns = 12'800, apart = 64; // pixels from one close to dark to the next
  for (const std::uint32_t images : {3u, 4u})
    for (const bool two_tap : {true, false})
      for (const double signal_e : {200.0, 5e3, 1e6, 3e6, 1e7}) {
        INFO(images << " images, " << (two_tap ? 2 : 1) << " taps, " << signal_e << " e");
        Electronics electronics = plain_electronics();
        electronics.two_tap = two_tap;
        electronics.demodulation_contrast = {1.0};
        electronics.dark_current_e_per_s = 0.0;
        const LightLevels levels = light_levels(electronics, images, {signal_e}, 0.0, columns);
        Measurement bright = levels.noiseless;
        Return &of = bright.returns[0];
        for (std::size_t i = 0; i < columns; ++i) {
          // About 64 electrons in the darkest tap, below which they are counted one by one.
          const double darkest_e = 64.0 + 2.0 * (static_cast<double>(i) / columns - 0.5);
          const double part = i % apart == 5 ? 1.0 - 2.0 * darkest_e / signal_e : 0.3;
          of.amplitude[i] *= static_cast<float>(part);
          const auto half_steps = static_cast<double>(i / apart % (2 * images));
          of.phase_rad[i] = static_cast<float>(half_steps * std::acos(-1.0) / images);
        }
        Measurement beside_dark = bright;
        for (std::size_t i = 6; i < columns; i += apart)
          beside_dark.returns[0].amplitude[i] = beside_dark.mean_radiance[i] = 0.0f;
        count_electrons(levels.sensor, {.keep_taps = true}, bright);
        count_electrons(levels.sensor, {.keep_taps = true}, beside_dark);
        std::size_t different = 0;
        for (const auto taps : {&Return::tap_a_e, &Return::tap_b_e})
          for (std::size_t k = 0; k < (bright.returns[0].*taps).size(); ++k)
            for (std::size_t i = 5; i < columns; i += apart)
              different += (bright.returns[0].*taps)[k][i] != (beside_dark.returns[0].*taps)[k][i] ? 1u : 0u;
        CHECK(different == 0);
      }
}

namespace {

// A row of even light, from `from_e` electrons of a tap's mean to `to_e`.
Measurement rising_light(const LightLevels &levels, double from_e, double to_e, double part) {
  Measurement rising = levels.noiseless;
  const std::size_t pixels = rising.mean_radiance.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    const double mean_e = from_e + (to_e - from_e) * static_cast<double>(i) / static_cast<double>(pixels);
    rising.mean_radiance[i] = static_cast<float>(2.0 * mean_e / electrons_of(1.0, levels.sensor));
    rising.returns[0].amplitude[i] = static_cast<float>(part) * rising.mean_radiance[i];
    if (part == 1.0) // one of the taps has none
      rising.returns[0].phase_rad[i] = 0.0f;
  }
  return rising;
}

// The same with a full pixel in every 16, and of those between the number whose channels differ.
std::size_t pixels_that_full_ones_change(const LightLevels &levels, const Measurement &light) {
  constexpr std::size_t apart = 16;
  Measurement alone = light, beside_full = light;
  for (std::size_t i = 0; i < light.mean_radiance.size(); i += apart)
    beside_full.mean_radiance[i] = static_cast<float>(1e9 / electrons_of(1.0, levels.sensor));
  count_electrons(levels.sensor, {.keep_taps = true}, alone);
  count_electrons(levels.sensor, {.keep_taps = true}, beside_full);
  std::size_t different = 0;
  const auto compare = [&](const auto &a, const auto &b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      different += i % apart != 0 && std::memcmp(&a[i], &b[i], sizeof(a[i])) != 0 ? 1u : 0u;
  };
  const Return &a = alone.returns[0], &b = beside_full.returns[0];
  for (const auto channel : {&Return::amplitude, &Return::phase_rad, &Return::distance_m,
                             &Return::distance_noise_m, &Return::confidence})
    compare(a.*channel, b.*channel);
  compare(a.saturated, b.saturated);
  for (const auto taps :
       {&Return::taps, &Return::tap_a_e, &Return::tap_b_e, &Return::tap_a_dn, &Return::tap_b_dn})
    for (std::size_t k = 0; k < (a.*taps).size(); ++k)
      compare((a.*taps)[k], (b.*taps)[k]);
  return different;
}

} // namespace

TEST_CASE("nor however close to the ends of what the camera reads") {
  constexpr std::uint32_t columns = 48'000;
  struct Ends {
    double from_e, to_e, offset_dn, full_well_e, read_noise_e, pattern;
    double dark_e = 0.0; // of a tap
    double part = 0.01;  // of the light
  };
  for (const Ends &ends :
       {Ends{64.0, 700.0, 0.0, 50e3, 25.0, 0.0}, Ends{64.0, 700.0, 0.0, 50e3, 25.0, 1.0},
        Ends{64.0, 300.0, 0.0, 50e3, 0.5, 0.0}, Ends{44e3, 51e3, 40.0, 50e3, 25.0, 0.0},
        Ends{40e3, 52e3, 40.0, 50e3, 25.0, 1.0}, Ends{46e3, 52e3, 40.0, 1e6, 25.0, 0.0},
        Ends{44e3, 51e3, 40.0, 50e3, 0.5, 0.0}, Ends{200.0, 5e3, 40.0, 50e3, 25.0, 0.0, 100.3, 1.0}})
    for (const std::uint32_t images : {3u, 4u})
      for (const bool two_tap : {true, false}) {
        INFO(images << " images, " << (two_tap ? 2 : 1) << " taps, from " << ends.from_e << " e, read noise "
                    << ends.read_noise_e << " e, pattern " << ends.pattern);
        Electronics electronics = plain_electronics();
        electronics.two_tap = two_tap;
        electronics.dark_current_e_per_s = 2.0 * ends.dark_e / electronics.integration_time_s;
        electronics.demodulation_contrast = {1.0};
        electronics.offset_dn = ends.offset_dn;
        electronics.full_well_e = ends.full_well_e;
        electronics.read_noise_e = ends.read_noise_e;
        electronics.prnu = 0.01 * ends.pattern;
        electronics.dsnu_e = 10.0 * ends.pattern;
        const LightLevels levels = light_levels(electronics, images, {1.0}, 1.1, columns);
        CHECK(pixels_that_full_ones_change(levels, rising_light(levels, ends.from_e, ends.to_e, ends.part)) ==
              0);
      }
}

TEST_CASE("neighbouring pixels, taps, images and frames know nothing of each other") {
  const LightLevels levels = light_levels(plain_electronics(), 4, {5000.0}, 0.9, 256);
  // Sums of products of deviations from each channel's mean over all frames.
  constexpr std::uint32_t frames = 2000;
  Moments pixels, taps, images, before;
  Return last;
  std::vector<Moments> of(3);
  for (std::uint32_t number = 0; number < frames; ++number) {
    Return frame = noisy_frame(levels, number).returns[0];
    for (std::size_t i = 0; i + 1 < 256; ++i) {
      of[0].add(frame.tap_a_e[0][i]);
      of[1].add(frame.tap_b_e[0][i]);
      of[2].add(frame.tap_a_e[1][i]);
    }
  }
  const auto off = [&](const std::vector<float> &channel, std::size_t i, std::size_t which) {
    return (channel[i] - of[which].mean()) / std::sqrt(of[which].variance());
  };
  for (std::uint32_t number = 0; number < frames; ++number) {
    Return frame = noisy_frame(levels, number).returns[0];
    for (std::size_t i = 0; i + 1 < 256; ++i) {
      const double here = off(frame.tap_a_e[0], i, 0);
      pixels.add(here * off(frame.tap_a_e[0], i + 1, 0));
      taps.add(here * off(frame.tap_b_e[0], i, 1));
      images.add(here * off(frame.tap_a_e[1], i, 2));
      if (number > 0)
        before.add(here * off(last.tap_a_e[0], i, 0));
    }
    last = std::move(frame);
  }
  for (const auto &[name, products] : {std::pair("pixels", pixels), std::pair("taps", taps),
                                       std::pair("images", images), std::pair("frames", before)}) {
    const double errors = products.mean() * std::sqrt(products.count() / products.variance());
    fmt::print("correlation of neighbouring {}: {:.6f}, {:.2f} standard errors\n", name, products.mean(),
               errors);
    CHECK(std::abs(errors) < 3.0);
  }
}
