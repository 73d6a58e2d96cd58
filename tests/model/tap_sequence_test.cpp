// The return that follows from taps that were taken one after the other.

#include "engine/model/tap_sequence.h"
#include "engine/reference/reference.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double modulation_hz = 20e6;

// The taps of one pixel, for a correlation function of the phase.
template <typename Correlation>
std::vector<std::vector<float>> taps_of(std::uint32_t count, double phase_rad, Correlation correlation) {
  std::vector<std::vector<float>> taps;
  for (std::uint32_t k = 0; k < count; ++k)
    taps.push_back({static_cast<float>(correlation(phase_rad - full_turn_rad * k / count))});
  return taps;
}

double cosine_of(double phase_rad) { return std::cos(phase_rad); }

void check_dark(const Return &result) {
  CHECK(result.amplitude[0] == 0.0f);
  CHECK(std::isnan(result.phase_rad[0]));
  CHECK(std::isnan(result.distance_m[0]));
}

// A wall over the upper left of the view; what is beyond it stays dark.
Measurement measured(const Sensor &sensor) {
  SceneBuilder builder;
  builder.add_wall({5.3, {}, {-10.0, -10.0}, {0.02, 0.01}});
  return reference::to_measurement(reference::simulate(
      builder.scene(), sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::lambert));
}

void check_same(const Return &found, const Return &expected, double ambiguity_m) {
  for (std::size_t pixel = 0; pixel < expected.amplitude.size(); ++pixel) {
    INFO("pixel " << pixel);
    REQUIRE(std::isnan(found.phase_rad[pixel]) == std::isnan(expected.phase_rad[pixel]));
    CHECK(found.amplitude[pixel] == Approx(expected.amplitude[pixel]).epsilon(1e-6));
    if (std::isnan(expected.phase_rad[pixel]))
      continue;
    CHECK(found.phase_rad[pixel] == Approx(expected.phase_rad[pixel]).margin(2e-6));
    CHECK(found.distance_m[pixel] == Approx(expected.distance_m[pixel]).margin(3e-7 * ambiguity_m));
  }
}

} // namespace

TEST_CASE("the taps of a sine give its amplitude and phase back") {
  const auto taps = static_cast<std::uint32_t>(GENERATE(range(3, 17)));
  for (const double phase_rad : {0.0, 0.3, 1.5708, 3.0, 4.7, 6.28}) {
    INFO(taps << " taps, " << phase_rad << " rad");
    const Return result =
        return_from_taps(taps_of(taps, phase_rad, [](double x) { return 0.7 * std::cos(x); }), modulation_hz);
    CHECK(result.amplitude[0] == Approx(0.7).epsilon(1e-6));
    CHECK(std::remainder(result.phase_rad[0] - phase_rad, full_turn_rad) == Approx(0.0).margin(1e-6));
    const double distance_m = speed_of_light_m_s * phase_rad / (2.0 * full_turn_rad * modulation_hz);
    CHECK(result.distance_m[0] == Approx(distance_m).margin(1e-6));
    CHECK(result.taps.size() == taps);
  }
}

TEST_CASE("the taps of a scene at rest give what is measured at once") {
  Sensor sensor;
  sensor.resolution = {4, 4};
  sensor.pixel_pitch_m = {3e-4, 3e-4}; // 0.6 mm to either side of the axis, behind 0.144 m
  sensor.taps = static_cast<std::uint32_t>(GENERATE(range(3, 17)));
  sensor.modulation_hz = {modulation_hz, 53e6};
  sensor.waveform = GENERATE(as<Waveform>{}, Waveform{}, Waveform{Waveform::Kind::square, {}},
                             Waveform{Waveform::Kind::harmonics, {1.0, -0.4, 0.2}});
  const Measurement expected = measured(sensor);
  CHECK(std::isnan(expected.returns[0].phase_rad.back()));
  CHECK_FALSE(std::isnan(expected.returns[0].phase_rad.front()));
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    INFO(sensor.taps << " taps at " << sensor.modulation_hz[i] << " Hz");
    check_same(return_from_taps(expected.returns[i].taps, sensor.modulation_hz[i]), expected.returns[i],
               sensor.ambiguity_m(i));
  }
}

TEST_CASE("where taps cancel, the amplitude is 0 and there is no phase") {
  const auto taps = static_cast<std::uint32_t>(GENERATE(range(4, 17)));
  INFO(taps << " taps");
  check_dark(return_from_taps(taps_of(taps, 0.4, [](double) { return 0.0; }), modulation_hz));
  check_dark(return_from_taps(taps_of(taps, 0.4, [](double) { return 0.3; }), modulation_hz));
  // The second harmonic does not show in more than three taps.
  check_dark(return_from_taps(taps_of(taps, 0.4, [](double x) { return std::cos(2.0 * x); }), modulation_hz));
}

TEST_CASE("phase and distance stay below the end of their ranges, rounded to float too") {
  const Return result = return_from_taps({{1.0f}, {-1e-9f}, {-1.0f}, {1e-9f}}, modulation_hz);
  CHECK(result.phase_rad[0] == 0.0f); // 2 pi - 1e-9, which float rounds to more than 2 pi
  CHECK(result.distance_m[0] == 0.0f);
  const Return before = return_from_taps(taps_of(4, full_turn_rad - 1e-5, cosine_of), modulation_hz);
  CHECK(before.phase_rad[0] > 6.28f);
  CHECK(static_cast<double>(before.phase_rad[0]) < full_turn_rad);
}

TEST_CASE("taps follow one another, frequency by frequency") {
  Sensor sensor;
  sensor.taps = 4;
  sensor.modulation_hz = {20e6, 30e6};
  sensor.tap_interval_s = 1e-3;
  CHECK(tap_time_s(sensor, 5.0, 0, 0) == 5.0);
  CHECK(tap_time_s(sensor, 5.0, 0, 3) == Approx(5.003));
  CHECK(tap_time_s(sensor, 5.0, 1, 0) == Approx(5.004));
  CHECK(tap_time_s(sensor, 5.0, 1, 3) == Approx(5.007));
  CHECK(tap_sequence_s(sensor) == Approx(8e-3));
}
