// Electrons that are counted strip by strip, from the light as a device leaves it, are those of the whole
// frame.

#include "engine/model/error.h"
#include "tests/comparison/frame_bytes.h"
#include "tests/electronics/noisy_walls.h"

#include <catch2/catch.hpp>
#include <complex>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <utility>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

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
