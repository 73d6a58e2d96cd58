#include "engine/signal/frequency_records.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace pmdsim;

namespace {

const std::vector<double> modulation_hz{20e6, 1e3, 10e9};

Signal signal_with_taps() {
  Sensor sensor;
  sensor.modulation_hz = modulation_hz;
  return signal_of(sensor, {.device = {}, .keep_taps = true});
}

double sum_of(const shader::vec2 &pair) { return double{pair.x} + double{pair.y}; }

void check_largest_below(float below, double limit) {
  CHECK(double{below} < limit);
  CHECK(double{std::nextafter(below, std::numeric_limits<float>::infinity())} >= limit);
}

} // namespace

TEST_CASE("a frequency's turns and its ambiguity, to double precision") {
  const auto records = frequency_records(signal_with_taps(), 2.5, {});
  REQUIRE(records.size() == modulation_hz.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    INFO(modulation_hz[i] << " Hz");
    const double ambiguity_m = 299792458.0 / (2.0 * modulation_hz[i]);
    CHECK(sum_of(records[i].ambiguity_m) == Approx(ambiguity_m).epsilon(1e-14));
    CHECK(sum_of(records[i].turns_per_m) == Approx(1.0 / ambiguity_m).epsilon(1e-14));
    check_largest_below(records[i].below.x, 2.0 * std::numbers::pi);
    check_largest_below(records[i].below.y, ambiguity_m);
  }
}

TEST_CASE("a frequency knows its channels and its unit") {
  const Signal signal = signal_with_taps();
  const auto records = frequency_records(signal, 2.5, {});
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    CHECK(records[i].first_channel == signal.first_channel(i));
    CHECK(records[i].amplitude_scale == 2.5f);
  }
}

TEST_CASE("every frequency carries what was promised, or nothing") {
  for (const shader::Frequency &record : frequency_records(signal_with_taps(), 1.0, {}))
    CHECK((record.limit_m == 0.0f && record.per_condition_m == 0.0f && record.amplitude_limit == 0.0f));
  const Promise promise{1e-5, 2e-6, 3e-7, 1e-3, 2e-4, 3e-5};
  for (const shader::Frequency &record : frequency_records(signal_with_taps(), 1.0, promise)) {
    CHECK(record.limit_m == 1e-5f);
    CHECK(record.fixed_m == 2e-6f);
    CHECK(record.per_condition_m == 3e-7f);
    CHECK(record.amplitude_limit == 1e-3f);
    CHECK(record.amplitude_fixed == 2e-4f);
    CHECK(record.amplitude_per_condition == 3e-5f);
  }
}
