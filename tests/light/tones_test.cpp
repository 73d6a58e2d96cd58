// How many planes and tones each waveform takes, and which.

#include "engine/light/tones.h"

#include <catch2/catch.hpp>
#include <numbers>

using namespace pmdsim;

namespace {

Sensor sensor_with(const Waveform &waveform, std::uint32_t taps, const std::vector<double> &modulation_hz) {
  Sensor sensor;
  sensor.waveform = waveform;
  sensor.taps = taps;
  sensor.modulation_hz = modulation_hz;
  return sensor;
}

const Waveform sine{Waveform::Kind::sine, {}}, square{Waveform::Kind::square, {}},
    three_harmonics{Waveform::Kind::harmonics, {1.0, -0.5, 0.25}};

double turns_per_m(const shader::Tone &tone) {
  return double(tone.turns_per_m.x) + double(tone.turns_per_m.y);
}

} // namespace

TEST_CASE("a sine takes a plane and a tone of each frequency, summed by moments") {
  const Modulation signal = modulation_of(sensor_with(sine, 5, {20e6, 60e6}), {});
  CHECK(signal.waveform == shader::waveform_sine);
  CHECK(signal.by_moments());
  CHECK(signal.sum_planes() == 2);
  const auto tones = signal.all_tones();
  REQUIRE(tones.size() == 2);
  CHECK(tones[1].wavenumber == Approx(2 * std::numbers::pi * 60e6 / 299792458.0));
  CHECK(turns_per_m(tones[1]) == Approx(60e6 / 299792458.0).epsilon(1e-14));
  CHECK(signal.largest_wavenumber_rad_m() == Approx(2 * std::numbers::pi * 60e6 / 299792458.0));
}

TEST_CASE("harmonics take a plane and a tone each, of each frequency in turn") {
  const Modulation signal = modulation_of(sensor_with(three_harmonics, 4, {20e6, 30e6}), {});
  CHECK(signal.waveform == shader::waveform_harmonics);
  CHECK(signal.planes == 3);
  CHECK(signal.sum_planes() == 6);
  CHECK(signal.harmonics == std::vector<float>{1.0f, -0.5f, 0.25f});
  const auto tones = signal.all_tones();
  REQUIRE(tones.size() == 6);
  const double expected_hz[] = {20e6, 40e6, 60e6, 30e6, 60e6, 90e6};
  for (std::size_t i = 0; i < tones.size(); ++i) {
    CHECK(tones[i].wavenumber == Approx(2 * std::numbers::pi * expected_hz[i] / 299792458.0));
    CHECK(turns_per_m(tones[i]) == Approx(expected_hz[i] / 299792458.0).epsilon(1e-14));
    CHECK(tones[i].harmonic == float(i % 3 + 1));
  }
  CHECK(signal.largest_wavenumber_rad_m() == Approx(2 * std::numbers::pi * 90e6 / 299792458.0));
}

TEST_CASE("square light takes half a plane of each tap that no other gives, one frequency at a time") {
  const auto [taps, distinct, planes] = GENERATE(table<std::uint32_t, std::uint32_t, std::uint32_t>(
      {{3, 3, 2}, {4, 2, 1}, {5, 5, 3}, {6, 3, 2}, {16, 8, 4}}));
  const Modulation signal = modulation_of(sensor_with(square, taps, {20e6, 30e6, 40e6}), {});
  CHECK(signal.waveform == shader::waveform_square);
  CHECK_FALSE(signal.by_moments());
  CHECK(signal.distinct_taps == distinct);
  CHECK(signal.planes == planes);
  CHECK(signal.sum_planes() == 3 * planes);
  CHECK(signal.all_tones().size() == 3);
}
