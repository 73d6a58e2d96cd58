// What light that bounces adds to frames whose taps are exposures of their own: closed forms.

#include "host/capture/exposure.h"
#include "host/capture/multipath_of_taps.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

using namespace pmdsim;

namespace {

using Complex = std::complex<double>;

constexpr double turn_rad = 2.0 * std::numbers::pi;

// What came directly and what bounced, in one exposure.
struct LitPixel {
  Complex direct, indirect;
};

Sensor bouncing_sensor() {
  Sensor sensor;
  sensor.modulation_hz = {20e6, 50e6};
  sensor.taps = 5;
  return sensor;
}

// An exposure at one frequency, a pixel for each of `pixels`.
Measurement exposure_of(const std::vector<LitPixel> &pixels, std::uint32_t taps, float error_m) {
  Return returned;
  returned.taps.resize(taps);
  for (const auto &[direct, indirect] : pixels) {
    const bool is_lit = std::abs(direct) > 0.0;
    returned.direct_amplitude.push_back(static_cast<float>(std::abs(direct)));
    returned.direct_phase_rad.push_back(
        is_lit ? static_cast<float>(std::fmod(std::arg(direct) + turn_rad, turn_rad))
               : std::numeric_limits<float>::quiet_NaN());
    returned.multipath_error_m.push_back(error_m);
    for (std::uint32_t k = 0; k < taps; ++k)
      returned.taps[k].push_back(
          static_cast<float>(std::real((direct + indirect) * std::polar(1.0, -turn_rad * k / taps))));
  }
  Measurement measurement;
  measurement.returns = {returned};
  measurement.bounces = BouncesReport{100, 1000, 7, static_cast<double>(error_m)};
  return measurement;
}

// The same light in all exposures; each claims a larger error than the one before.
Measurement at_rest(const Sensor &sensor, const std::vector<LitPixel> &pixels) {
  float error_m = 0.0f;
  return measure_tap_by_tap(
      sensor, 0.0, [&](std::size_t, double) { return exposure_of(pixels, sensor.taps, error_m += 1e-3f); });
}

} // namespace

TEST_CASE("multipath of taps at rest is that of one exposure") {
  const Sensor sensor = bouncing_sensor();
  const LitPixel light{std::polar(2.0, 1.0), std::polar(0.5, 1.8)};
  const Measurement frame = at_rest(sensor, {light});
  REQUIRE(frame.returns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const Return &found = frame.returns[i];
    const double m_per_rad = sensor.ambiguity_m(i) / turn_rad;
    const Complex z = light.direct + light.indirect;
    CHECK(found.direct_amplitude[0] == Approx(2.0));
    CHECK(found.direct_phase_rad[0] == Approx(1.0));
    CHECK(found.direct_distance_m[0] == Approx(m_per_rad));
    CHECK(found.multipath_m[0] == Approx(m_per_rad * (std::arg(z) - 1.0)).margin(2e-6));
    CHECK(found.indirect_share[0] == Approx(0.5 / std::abs(z)));
    // The last exposure of each frequency claims most.
    CHECK(found.multipath_error_m[0] == Approx(1e-3 * 5.0 * (static_cast<double>(i) + 1.0)));
  }
}

TEST_CASE("the exposures' bounces add up, the first frequency's largest error is claimed") {
  const Measurement frame = at_rest(bouncing_sensor(), {{1.0, 0.1}});
  REQUIRE(frame.bounces);
  CHECK(frame.bounces->elements == 100);
  CHECK(frame.bounces->lines == 10'000);
  CHECK(frame.bounces->products == 70);
  CHECK(frame.bounces->claimed_m == Approx(5e-3));
}

TEST_CASE("each tap takes its own exposure's direct light") {
  Sensor sensor = bouncing_sensor();
  sensor.modulation_hz = {20e6};
  sensor.tap_interval_s = 1.0;
  const auto light_at = [](double time_s) {
    return LitPixel{std::polar(2.0 - 0.1 * time_s, 1.0 + 0.05 * time_s), std::polar(0.5 + 0.1 * time_s, 2.0)};
  };
  const Measurement frame = measure_tap_by_tap(sensor, 0.0, [&](std::size_t, double time_s) {
    return exposure_of({light_at(time_s)}, sensor.taps, 1e-3f);
  });
  Complex direct = 0.0, whole = 0.0;
  for (std::uint32_t k = 0; k < sensor.taps; ++k) {
    const Complex reference = std::polar(1.0, turn_rad * k / sensor.taps);
    const LitPixel light = light_at(k);
    direct += 2.0 / sensor.taps * std::real(light.direct * std::conj(reference)) * reference;
    whole +=
        2.0 / sensor.taps * std::real((light.direct + light.indirect) * std::conj(reference)) * reference;
  }
  const Return &found = frame.returns[0];
  CHECK(found.direct_amplitude[0] == Approx(std::abs(direct)));
  CHECK(found.direct_phase_rad[0] == Approx(std::arg(direct)));
  CHECK(found.multipath_m[0] ==
        Approx(sensor.ambiguity_m(0) / turn_rad * (std::arg(whole) - std::arg(direct))).margin(2e-6));
  CHECK(found.indirect_share[0] == Approx(std::abs(whole - direct) / std::abs(whole)));
}

TEST_CASE("multipath of taps wraps, and is nothing where either distance is") {
  const Sensor sensor = bouncing_sensor();
  const Measurement frame = at_rest(sensor, {{std::polar(1.0, 0.1), std::polar(2.0, -0.3)}, // across 0
                                             {0.0, std::polar(1.0, 1.0)},                   // in the shade
                                             {0.0, 0.0}});
  const Return &found = frame.returns[0];
  CHECK(found.multipath_m[0] < 0.0f);
  CHECK(found.multipath_m[0] > -0.5f);
  CHECK(std::isnan(found.multipath_m[1]));
  CHECK(found.indirect_share[1] == Approx(1.0));
  CHECK(std::isnan(found.direct_distance_m[1]));
  CHECK_FALSE(std::isnan(found.multipath_error_m[1]));
  CHECK(std::isnan(found.multipath_m[2]));
  CHECK(std::isnan(found.indirect_share[2]));
  CHECK(std::isnan(found.multipath_error_m[2]));
}

TEST_CASE("of other waveforms frames of taps have no channels of multipath") {
  Sensor sensor = bouncing_sensor();
  sensor.waveform.kind = Waveform::Kind::square;
  const Measurement frame = at_rest(sensor, {{1.0, 0.1}});
  CHECK(frame.returns[0].multipath_m.empty());
  CHECK(frame.returns[0].direct_amplitude.empty());
  REQUIRE(frame.bounces);
  CHECK(frame.bounces->lines == 10'000);
  CHECK(std::isnan(frame.bounces->claimed_m));
}

TEST_CASE("without bounces frames of taps have no multipath") {
  const Sensor sensor = bouncing_sensor();
  const Measurement frame = measure_tap_by_tap(sensor, 0.0, [&](std::size_t, double) {
    Measurement exposure = exposure_of({{1.0, 0.0}}, sensor.taps, 0.0f);
    exposure.bounces = std::nullopt;
    return exposure;
  });
  CHECK_FALSE(frame.bounces);
  CHECK(frame.returns[0].multipath_m.empty());
}

TEST_CASE("a frame takes more memory where light bounces") {
  Sensor sensor = bouncing_sensor();
  sensor.resolution = {8, 4};
  const std::size_t channels = 6; // of each frequency
  CHECK(bytes_of_frame(sensor, false, {.count = 1}) ==
        bytes_of_frame(sensor, false, {}) + channels * 2 * 32 * sizeof(float));
}
