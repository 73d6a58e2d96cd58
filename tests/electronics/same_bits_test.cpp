// The same seed gives the same bits: whatever vectors, strips, threads and order of frames, and, but for the
// last bit of a mean, those of the judge.

#include "engine/reference/reference.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/electronics/fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Scene two_walls() {
  SceneBuilder builder;
  builder.add_wall({1.7, {.reflectivity = 0.6}, {-2.0, -2.0}, {0.05, 2.0}});
  builder.add_wall({2.4, {.reflectivity = 0.2}, {0.05, -2.0}, {2.0, 2.0}});
  return builder.scene();
}

Sensor noisy_sensor() {
  Sensor sensor;
  sensor.resolution = {67, 45};
  sensor.pixel_pitch_m = {15e-6, 15e-6};
  sensor.focal_length_m = 0.002;
  sensor.modulation_hz = {20e6, 80e6};
  sensor.electronics = plain_electronics();
  sensor.electronics->dsnu_e = 30.0;
  sensor.electronics->prnu = 0.01;
  return sensor;
}

std::vector<Illuminator> two_lights(const Sensor &sensor) {
  Illuminator first = diode_beside_lens(sensor, diode_at({0.03, 0.0, 0.0})),
              second = diode_beside_lens(sensor, diode_at({-0.04, 0.02, 0.0}));
  first.diodes[0].intensity_w_sr = 0.4;
  first.modulation_depth = 0.8;
  second.diodes[0].intensity_w_sr = 0.2;
  second.modulation_depth = 0.5;
  second.modulation_phase_rad = 0.6;
  return {first, second};
}

// Of a picture: each pixel's own part of 20 mW/(m^2 sr).
void give_uneven_background(Electronics &electronics, std::size_t pixels) {
  electronics.background_radiance_w_m2_sr = 0.02;
  for (std::size_t i = 0; i < pixels; ++i)
    electronics.background_image.push_back(static_cast<float>(i % 101) / 100.0f);
}

Measurement measured(const Sensor &sensor, const SimulatorOptions &options = {}, std::uint32_t frame = 7) {
  Simulator simulator = make_simulator(options);
  simulator.prepare(two_walls(), sensor, two_lights(sensor), Backscatter::lambert, Shadows::automatic);
  Measurement measurement = simulator.measure({}, {2, frame, 0});
  count_electrons(sensor, {.keep_taps = true, .host_vector_bits = options.host_vector_bits}, measurement);
  return measurement;
}

} // namespace

TEST_CASE("electrons are the same in two runs, strips, threads and vectors of any width") {
  const Sensor sensor = noisy_sensor();
  const std::string expected = bytes_of(measured(sensor));
  CHECK(bytes_of(measured(sensor)) == expected);
  CHECK(bytes_of(measured(sensor, {.device = {}, .max_strip_samples = 700})) == expected);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(bytes_of(measured(sensor)) == expected);
  }
  // Light of narrower vectors differs in its last bits; electrons of the same light do not.
  Measurement light = measured(sensor);
  for (const bool two_tap : {true, false})
    for (const double read_noise_e : {0.0, 0.3, 25.0}) {
      std::string of_widest;
      for (const std::uint32_t bits : {512u, 256u, 128u}) {
        Sensor changed = sensor;
        changed.electronics->two_tap = two_tap;
        changed.electronics->read_noise_e = read_noise_e;
        Measurement frame = light;
        for (Return &of : frame.returns)
          for (std::size_t i = 0; i < of.amplitude.size(); ++i) {
            // In the first half taps of each vector are bright and dark, in the second all are bright.
            const float part = i < of.amplitude.size() / 2 ? static_cast<float>(i % 61) / 36.0f : 0.5f;
            of.amplitude[i] = part * frame.mean_radiance[i];
            of.phase_rad[i] = static_cast<float>(i % 629) * 0.01f;
          }
        count_electrons(changed, {.keep_taps = true, .host_vector_bits = bits}, frame);
        if (of_widest.empty())
          of_widest = bytes_of(frame);
        CHECK(bytes_of(frame) == of_widest);
      }
    }
}

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

TEST_CASE("another seed, frame, sensor or frequency gives other noise") {
  const Sensor sensor = noisy_sensor();
  const Measurement frame = measured(sensor);
  CHECK(measured(sensor, {}, 8).returns[0].tap_a_e != frame.returns[0].tap_a_e);
  Sensor reseeded = sensor;
  reseeded.electronics->seed += std::uint64_t{1} << 33;
  CHECK(measured(reseeded).returns[0].tap_a_e != frame.returns[0].tap_a_e);
  const LightLevels levels = light_levels(plain_electronics(), 4, {5000.0});
  Measurement of_sensor = levels.noiseless;
  of_sensor.number.sensor = 1;
  count_electrons(levels.sensor, {.keep_taps = true}, of_sensor);
  CHECK(of_sensor.returns[0].tap_a_e != noisy_frame(levels, 0).returns[0].tap_a_e);
  LightLevels two = levels;
  two.sensor.modulation_hz.push_back(two.sensor.modulation_hz[0]);
  two.noiseless.returns.push_back(two.noiseless.returns[0]);
  const Measurement both = noisy_frame(two, 0);
  CHECK(both.returns[0].tap_a_e != both.returns[1].tap_a_e);
}

TEST_CASE("the judge counts the same electrons, but for means that differ in their last bits") {
  for (const bool two_tap : {true, false})
    for (const double read_noise_e : {0.0, 25.0}) {
      Sensor sensor = noisy_sensor();
      sensor.electronics->two_tap = two_tap;
      sensor.electronics->read_noise_e = read_noise_e;
      give_uneven_background(*sensor.electronics, sensor.pixel_count());
      const Measurement found = measured(sensor);
      const reference::Frame light = reference::simulate(two_walls(), sensor, two_lights(sensor),
                                                         Backscatter::lambert, {Shadows::automatic});
      Measurement judged = reference::to_measurement(light);
      judged.number = found.number;
      reference::count_electrons(light, sensor, true, judged);
      std::size_t apart = 0, all = 0;
      double largest_e = 0.0;
      for (std::size_t f = 0; f < 2; ++f)
        for (std::size_t k = 0; k < 4; ++k)
          for (std::size_t i = 0; i < sensor.pixel_count(); ++i) {
            const Return &a = found.returns[f], &b = judged.returns[f];
            apart += a.tap_a_dn[k][i] != b.tap_a_dn[k][i] ? 1u : 0u;
            largest_e = std::max(largest_e, static_cast<double>(std::abs(a.tap_a_e[k][i] - b.tap_a_e[k][i])));
            ++all;
          }
      fmt::print(
          "device and judge, {} taps, read noise {:>4} e: {} of {} numbers differ, electrons by {:.3g}\n",
          two_tap ? 2 : 1, read_noise_e, apart, all, largest_e);
      CHECK(static_cast<double>(apart) < 1e-3 * static_cast<double>(all));
      CHECK(largest_e <= 1.01);
      double largest = 0.0;
      for (std::size_t i = 0; i < sensor.pixel_count(); ++i)
        if (!std::isnan(judged.returns[1].distance_noise_m[i]))
          largest =
              std::max(largest, std::abs(found.returns[1].distance_noise_m[i] /
                                             static_cast<double>(judged.returns[1].distance_noise_m[i]) -
                                         1.0));
      CHECK(largest < 1e-4);
      CHECK(found.returns[1].saturated == judged.returns[1].saturated);
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
