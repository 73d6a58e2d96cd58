// The same seed gives the same bits: whatever vectors, strips, threads and order of frames, and, but for the
// last bit of a mean, those of the judge.

#include "engine/reference/reference.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/electronics/noisy_walls.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

using namespace pmdsim;
using namespace pmdsim::test;

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
