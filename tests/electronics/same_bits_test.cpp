// The same seed gives the same bits: whatever vectors, strips, threads and order of frames, and, but for the
// last bit of a mean, those of the judge.

#include "engine/model/error.h"
#include "engine/reference/reference.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/electronics/fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <complex>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <tbb/global_control.h>
#include <utility>

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
  CHECK(measurement.has_electrons == (options.count_electrons && counts_by_strips(sensor)));
  if (!measurement.has_electrons)
    count_electrons(sensor, {.keep_taps = true, .host_vector_bits = options.host_vector_bits}, measurement);
  return measurement;
}

// A frame's light as a device would leave that of some of its pixels.
struct Tile {
  Tile(const Measurement &frame, StripLight at) : light(std::move(at)) {
    mean.reserve(std::size_t{2} * light.columns * light.rows);
    for (const Return &of : frame.returns) {
      std::vector<float> &pairs = returns.emplace_back();
      for (std::uint32_t row = light.row; row < light.row + light.rows; ++row)
        for (std::uint32_t column = light.column; column < light.column + light.columns; ++column) {
          const std::size_t pixel = std::size_t{row} * frame.resolution.x + column;
          if (light.is_complex) {
            const std::complex<float> z = std::polar(of.amplitude[pixel], of.phase_rad[pixel]);
            pairs.insert(pairs.end(), {z.real(), z.imag()});
          } else {
            pairs.insert(pairs.end(), {of.amplitude[pixel], of.phase_rad[pixel]});
          }
          if (&of == frame.returns.data())
            mean.insert(mean.end(), {frame.mean_radiance[pixel], -1.0f});
        }
    }
    for (const std::vector<float> &pairs : returns)
      light.returns.push_back(pairs.data());
    light.mean_radiance = mean.data();
  }

  std::vector<std::vector<float>> returns;
  std::vector<float> mean;
  StripLight light;
};

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

TEST_CASE("electrons strip by strip are those of the whole frame") {
  for (const bool two_tap : {true, false})
    for (const bool has_picture : {false, true}) {
      Sensor sensor = noisy_sensor();
      sensor.electronics->two_tap = two_tap;
      if (has_picture)
        give_uneven_background(*sensor.electronics, sensor.pixel_count());
      SimulatorOptions options{.device = {}, .keep_taps = true};
      const std::string of_host = bytes_of(measured(sensor, options));
      options.allowed.host_pixels = false;
      const std::string of_device = bytes_of(measured(sensor, options));
      options.count_electrons = true;
      options.max_strip_samples = 700;
      CHECK(bytes_of(measured(sensor, options)) == of_device);
      sensor.electronics->noiseless_channels = true; // they are taken from the whole frame
      options.allowed.host_pixels = true;
      Measurement both = measured(sensor, options);
      for (Return &of : both.returns) {
        CHECK(of.phase_rad_noiseless != of.phase_rad);
        for (auto *channel : {&of.amplitude_noiseless, &of.phase_rad_noiseless, &of.distance_m_noiseless})
          channel->clear();
      }
      CHECK(bytes_of(both) == of_host);
    }
}

TEST_CASE("electrons of complex returns are those of amplitude and phase, but for the light's last bits") {
  for (const bool two_tap : {true, false}) {
    Sensor sensor = noisy_sensor();
    sensor.electronics->two_tap = two_tap;
    SimulatorOptions options{.device = {}, .keep_taps = true};
    const Measurement polar = measured(sensor, options);
    options.count_electrons = true;
    const Measurement complex = measured(sensor, options);
    options.max_strip_samples = 700;
    CHECK(bytes_of(measured(sensor, options)) == bytes_of(complex));
    options.keep_taps = false;
    const Return without = measured(sensor, options).returns[1];
    CHECK(without.taps.empty());
    CHECK(without.tap_a_e.empty());
    CHECK(without.phase_rad == complex.returns[1].phase_rad);
    CHECK(complex.mean_radiance == polar.mean_radiance);
    CHECK(std::memcmp(complex.range_m.data(), polar.range_m.data(), sizeof(float) * polar.range_m.size()) ==
          0);
    std::size_t different = 0, all = 0;
    for (std::size_t f = 0; f < 2; ++f)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < sensor.pixel_count(); ++i, ++all)
          different += complex.returns[f].tap_a_dn[k][i] != polar.returns[f].tap_a_dn[k][i] ? 1u : 0u;
    fmt::print("complex returns, {} taps: {} of {} numbers differ\n", two_tap ? 2 : 1, different, all);
    CHECK(static_cast<double>(different) < 1e-3 * static_cast<double>(all));
  }
}

TEST_CASE("electrons of parts of rows are those of the whole frame") {
  const Sensor sensor = noisy_sensor();
  Simulator simulator = make_simulator({});
  simulator.prepare(two_walls(), sensor, two_lights(sensor), Backscatter::lambert, Shadows::automatic);
  const Measurement light = simulator.measure({}, {2, 7, 0});
  Measurement whole = light, in_tiles = light;
  count_electrons(sensor, {.keep_taps = true}, whole);
  for (const std::uint32_t column : {0u, 1u, 60u})
    for (const std::uint32_t row : {0u, 30u}) {
      const std::uint32_t end = column == 0 ? 1 : column == 1 ? 60 : 67;
      const Tile tile(light, {column, row, end - column, row == 0 ? 30u : 15u, false, {}, nullptr});
      count_electrons(sensor, {.keep_taps = true}, tile.light, in_tiles);
    }
  CHECK(bytes_of(in_tiles) == bytes_of(whole));
}

TEST_CASE("light that no float holds is refused strip by strip, too") {
  const Sensor sensor = noisy_sensor();
  Measurement frame;
  frame.returns.resize(2);
  frame.resolution = sensor.resolution;
  for (Return &of : frame.returns)
    for (auto *channel : {&of.amplitude, &of.phase_rad, &of.distance_m})
      channel->assign(sensor.pixel_count(), 1.0f);
  frame.mean_radiance.assign(sensor.pixel_count(), 2.0f);
  for (const bool is_complex : {false, true}) {
    const auto count = [&] {
      Measurement counted = frame;
      const Tile tile(frame, {0, 0, sensor.resolution.x, sensor.resolution.y, is_complex, {}, nullptr});
      count_electrons(sensor, {}, tile.light, counted);
    };
    CHECK_NOTHROW(count());
    for (float *const value : {&frame.mean_radiance[999], &frame.returns[1].amplitude.back()}) {
      const float finite = std::exchange(*value, std::numeric_limits<float>::infinity());
      CHECK_THROWS_AS(count(), Error);
      *value = finite;
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
      const Measurement found = measured(sensor, {.device = {}, .keep_taps = true, .count_electrons = true});
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
